# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Reads files into memory, recognises their kind, and writes files atomically."""
from __future__ import annotations

import contextlib
import gzip
import importlib
import logging
import os
import re
import secrets
import stat
import struct
import tempfile
import warnings
import zlib
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

NAMES = {
    "gifti": "GIFTI", "cifti": "CIFTI", "nifti": "NIfTI", "mgh": "FreeSurfer mgh",
    "freesurfer": "FreeSurfer surface", "asc": "FreeSurfer asc", "curv": "FreeSurfer curv",
    "label": "FreeSurfer label", "annot": "FreeSurfer annot", "off": "OFF", "obj": "OBJ", "ply": "PLY",
    "stl": "STL", "3mf": "3MF", "vtk": "VTK legacy", "vtp": "VTK XML", "vtu": "VTK XML grid",
    "npy": "NumPy npy", "text": "text",
}

# The ends of names by which an output that is named like another format, or like none, is noticed.
EXTENSIONS = {
    ".gii": "gifti", ".mgh": "mgh", ".mgz": "mgh", ".label": "label", ".asc": "asc", ".off": "off", ".obj": "obj",
    ".ply": "ply", ".stl": "stl", ".3mf": "3mf", ".vtk": "vtk", ".vtp": "vtp", ".vtu": "vtu",
    ".npy": "npy", ".nii": "nifti",
    ".annot": "annot", ".txt": "text",
}

# Files of FreeSurfer have names such as lh.thickness.fwhm10, whose ends say nothing of the format.
_NAMED_FREELY = ("curv", "freesurfer")

# Formats that store single precision, also if the input is double
_SINGLE = ("gifti", "cifti", "curv", "mgh", "nifti", "freesurfer", "stl")

#: Of larger files of GIFTI the first bytes
_HEAD = 1 << 20

# CIFTI names say what the rows are: .dscalar.nii, .dtseries.nii, ...
_CIFTI_NAME = re.compile(r"\.([dp][a-z]+)\.nii$")


class FileError(ValueError):
    """A file that cannot be read or written; one line that names it."""


@dataclass
class Content:
    """partial: `bytes` are the beginning alone, since the file may be large and is on disk."""

    path: str
    bytes: bytes
    kind: str
    partial: bool = False

    @property
    def name(self):
        return NAMES[self.kind]

    def error(self, problem):
        return FileError(f"{self.path}: {problem}")


def read_content(path) -> Content:
    """The bytes of a file without compression, and the kind of their format."""
    path = os.fspath(path)
    try:
        with open(path, "rb") as file:
            if _is_cifti_on_disk(file):
                return Content(path, b"", "cifti", partial=True)
            data = file.read(_HEAD)
            if len(data) == _HEAD:
                if stat.S_ISREG(os.fstat(file.fileno()).st_mode) and _find_xml_kind(data) == "gifti":
                    return Content(path, data, "gifti", partial=True)
                data += file.read()
    except OSError as error:
        raise FileError(f"{path}: cannot be read: {error.strerror}") from error
    if data[:2] == b"\x1f\x8b":
        try:
            data = gzip.decompress(data)
        except (EOFError, OSError, zlib.error) as error:
            raise FileError(f"{path}: damaged gzip file: {error}") from error
    if not data:
        raise FileError(f"{path}: the file is empty")
    kind = find_kind(data) or _stl_with_more(path, data)
    if kind is None:
        raise FileError(f"{path}: {_unknown(path, data)}; allowed: " + ", ".join(NAMES.values()))
    return Content(path, data, kind)


def _unknown(path, data):
    """What a file is that has none of the kinds."""
    if data.startswith(b"PK\3\4"):
        return "an archive of files (zip) without the model of a 3MF file"
    if _plain_name(path).endswith((".img", ".hdr")):
        return "half of a pair of files .hdr and .img"
    return f"a file of unknown kind that starts with {data[:12]!r}"


def _stl_with_more(path, data):
    """Some programs write more bytes after the triangles than STL has; only by the name are such files
    distinguished from others."""
    size = _size_of_stl(data)
    if not _plain_name(path).endswith(".stl") or not 84 < size < len(data) or b"\0" not in data[:84]:
        return None
    warnings.warn(f"{path}: {len(data) - size} bytes after the {(size - 84) // 50} triangles of its header are "
                  "not read", stacklevel=3)
    return "stl"


def _is_cifti_on_disk(file):
    """Not of compressed files and of pipes, which are read at once. nibabel goes by the name."""
    if not stat.S_ISREG(os.fstat(file.fileno()).st_mode) or not file.name.lower().endswith(".nii"):
        return False
    head = file.read(540)
    file.seek(0)
    return _is_cifti(head)


@contextlib.contextmanager
def on_disk(data):
    """The path of a temporary file with these bytes, for libraries that read nothing else. The file
    they are from is opened once, in read_content(), because it may be compressed or a pipe."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "content")
        with open(path, "wb") as file:
            file.write(data)
        yield path


def find_kind(data: bytes) -> str | None:
    """The kind of a file with this content, a key of NAMES; None if unknown."""
    starts = {
        b"\xff\xff\xfe": "freesurfer", b"\xff\xff\xfd": "freesurfer",
        b"\xff\xff\xff": "freesurfer" if _has_quadrangles(data) else "curv",
        b"#!ascii label": "label", b"#!ascii version of": "asc", b"# vtk DataFile": "vtk", b"\x93NUMPY": "npy",
    }
    for start, kind in starts.items():
        if data.startswith(start):
            return kind
    if re.match(rb"ply\s", data):
        return "ply"
    return _find_xml_kind(data) or _find_binary_kind(data) or _find_text_kind(data)


def _find_xml_kind(data):
    """By the name of the root element. Before it may be a byte-order mark, declarations and comments
    of any length."""
    prolog = re.compile(rb"(?:\xef\xbb\xbf)?\s*(?:<\?.*?\?>|<!--.*?-->|<!DOCTYPE[^<>]*>)?", re.DOTALL)
    start = 0
    while (end := prolog.match(data, start).end()) > start:
        start = end
    if data.startswith(b"<GIFTI", start):
        return "gifti"
    if data.startswith(b"<VTKFile", start):
        is_grid = re.compile(rb"<VTKFile\s[^>]*type\s*=\s*[\"']UnstructuredGrid").match(data, start)
        return "vtu" if is_grid else "vtp"
    return None


def _is_nifti2(data, order):
    return len(data) >= 540 and struct.unpack_from(order + "i", data)[0] == 540


def _is_cifti(data):
    return any(_is_nifti2(data, order) and 3000 <= struct.unpack_from(order + "i", data, 504)[0] < 3100
               for order in "<>")


def _find_binary_kind(data):
    if data.startswith(b"PK\3\4") and b".model" in data:  # the names of files are not packed
        return "3mf"
    if _is_nifti2(data, "<") or _is_nifti2(data, ">"):
        return "cifti" if _is_cifti(data) else "nifti"
    if len(data) >= 348 and data[344:347] == b"n+1":
        return "nifti"
    if len(data) >= 284 and struct.unpack_from(">i", data)[0] == 1:
        return "mgh"
    if len(data) == _size_of_stl(data):
        return "stl"
    if len(data) >= 16:  # one pair of numbers per vertex, then the tag of the table of colours
        count = struct.unpack_from(">i", data)[0]
        if 0 < count <= (len(data) - 8) // 8 and struct.unpack_from(">i", data, 4 + 8 * count)[0] == 1:
            return "annot"
    return None


def _size_of_stl(data):
    """The bytes of a binary STL file with the number of triangles in the header."""
    return 84 + 50 * struct.unpack_from("<I", data, 80)[0] if len(data) >= 84 else 0


def _has_quadrangles(data):
    """Old surfaces of FreeSurfer start as curv files, with numbers of three bytes: of the vertices, three
    short integers each, and of the quadrangles, four numbers of vertices each."""
    vertices, faces = (int.from_bytes(data[place:place + 3], "big") for place in (3, 6))
    return len(data) == 9 + 6 * vertices + 12 * faces


def _find_text_kind(data):
    head = data[:4096]
    if b"\0" in head:
        return None
    start, comment = 0, re.compile(rb"\xef\xbb\xbf|\s+|#[^\r\n]*")
    while found := comment.match(data, start):
        start = found.end()
    if re.compile(rb"(ST)?C?N?4?n?OFF(\d|\s)").match(data, start):
        return "off"
    if re.match(rb"(?:\xef\xbb\xbf)?\s*solid\b", head, re.IGNORECASE):
        return "stl"
    if re.search(rb"(?:^|[\r\n])[ \t]*v[ \t]+[-+.\d]", data):
        return "obj"
    if re.compile(rb"[-+]?(\.?\d|nan\b|inf\b)", re.IGNORECASE).match(data, start):
        return "text"
    return None


def import_reader(package, content):
    """The package that reads this file, from the extra `io` or from VTK."""
    try:
        return importlib.import_module(package)
    except ImportError as error:
        top = package.split(".", maxsplit=1)[0]
        install = "vtk" if top == "vtkmodules" else "surfacediffusion[io]"
        raise content.error(f"{content.name} files require the package {top}: "
                            f"pip install {install!r}") from error


@contextlib.contextmanager
def reading(content):
    """Turns any exception of a reader into one line. Readers raise exceptions of many kinds for
    damaged files, hence the broad clause."""
    try:
        with silent_log():  # nibabel reports headers that it mends, on standard error
            yield
    except FileError:
        raise
    except Exception as error:
        reason = _in_plain_words(" ".join(str(error).split()), error)
        raise content.error(f"damaged {content.name} file: {reason[:200]}") from error


def _in_plain_words(text, error):
    """What Python and numpy say of words that are no numbers, and of files that end early."""
    if isinstance(error, IndexError):
        return "it ends too early"
    if isinstance(error, OverflowError):
        return "a number is too large"
    text = re.sub(r"(?:np\.(?:bytes|str)_\()?\bb?('[^']*'|\"[^\"]*\")\)?", r"\1", text)
    text = re.sub(r"could not convert string(?: to float:)? (.*?)(?: to float\d+ at row .*)?$",
                  r"\1 is no number", text)
    text = re.sub(r"invalid literal for int\(\) with base 10: (.*)", r"\1 is no whole number", text)
    text = re.sub(r"cannot reshape array of size (\d+) into shape \((.*?),?\)",
                  lambda found: f"{found[1]} numbers for an array of " + found[2].replace(",", " x "), text)
    return text or type(error).__name__


@contextlib.contextmanager
def silent_log(name="nibabel.global"):
    logger = logging.getLogger(name)
    level = logger.level
    logger.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        logger.setLevel(level)


def kind_of_name(path) -> str | None:
    """The kind that the name of an output file announces; None if it announces none."""
    name = _plain_name(path)
    return "cifti" if _CIFTI_NAME.search(name) else EXTENSIONS.get(os.path.splitext(name)[1])


def _plain_name(path):
    """Without compression, and without what AFNI adds: a.gii of a.gii.dset."""
    return re.sub(r"\.(gz|dset)$", "", os.path.basename(os.fspath(path)).lower())


def check_output_name(path, kind, rows=""):
    """An output is written in the format of the input, so its name must not say otherwise. rows: of
    CIFTI, "dscalar" or "dtseries"."""
    announced = kind_of_name(path)
    if kind == "cifti":
        found = _CIFTI_NAME.search(os.fspath(path).lower())
        if found and found[1] != rows:
            raise FileError(f"{path}: named .{found[1]}.nii, but it is written as .{rows}.nii, the "
                            "format of the input")
        if announced == "nifti":
            return
    extension = os.path.splitext(_plain_name(path))[1]
    is_free = kind in _NAMED_FREELY and not re.fullmatch(r"\.(csv|tsv|json|xlsx?)", extension)
    if extension and announced is None and not is_free:
        own = f".{rows}.nii" if kind == "cifti" else ", ".join(
            end for end, named in EXTENSIONS.items() if named == kind) or "no extension"
        raise FileError(f"{path}: {extension} names no format of files; allowed: {own}, since it is written as "
                        f"{NAMES[kind]}, the format of the input")
    if announced not in (None, kind):
        raise FileError(f"{path}: named as {NAMES[announced]}, but it is written as {NAMES[kind]}, "
                        "the format of the input")


def check_range(path, kind, arrays, what, single=False):
    """Raises FileError if the format has no such numbers. single: whether it holds single precision here."""
    blocks = (block for array in map(np.atleast_1d, arrays)
              for block in np.array_split(array, 1 + (array.size >> 20)))
    largest = max((np.abs(block).max(initial=0, where=np.isfinite(block)) for block in blocks), default=0)
    if (single or kind in _SINGLE) and largest > np.finfo(np.float32).max:
        raise FileError(f"{path}: a {what} is {largest:.3g}; allowed in {NAMES[kind]}: less than 3.4e38")


def check_output_folder(path):
    """Finds before a long computation that its result has no place to go."""
    folder = os.path.dirname(os.path.abspath(path))
    if os.fspath(path) == "-":
        raise FileError("-: cannot be written: it is not a file; allowed: the name of a file")
    if not os.path.isdir(folder):
        raise FileError(f"{path}: cannot be written: there is no folder {folder}")
    if os.path.isdir(path):
        raise FileError(f"{path}: cannot be written: it is a folder")
    if os.path.exists(path):
        if not os.path.isfile(path):  # a device or a pipe would be replaced
            raise FileError(f"{path}: cannot be written: it is not a regular file")
        # A new file takes its place, which needs no permission of the old one.
        if not os.access(path, os.W_OK) or not os.stat(path).st_mode & 0o222:
            raise FileError(f"{path}: cannot be written: the file there is write-protected")
    if not os.access(folder, os.W_OK):
        raise FileError(f"{path}: cannot be written: no permission to write in {folder}")


def write_atomically(path, data: bytes | Iterable[bytes]):
    """Writes `data`, or all of them one after the other, compressed if the name ends in .gz or .mgz. The output appears complete or
    not at all."""
    parts = [data] if isinstance(data, bytes) else data
    if is_compressed(path):
        data = b"".join(parts)
        parts = [gzip.compress(data, 1, mtime=0)]  # as nibabel: floats hardly shrink more
    with writing_atomically(path) as temporary, open(temporary, "wb") as file:
        for part in parts:
            file.write(part)


def is_compressed(path):
    """Whether the name of an output asks for compression."""
    return os.fspath(path).lower().endswith((".gz", ".mgz"))


@contextlib.contextmanager
def writing_atomically(path):
    """The path of a temporary file beside the output, which takes its name at the end."""
    path = os.fspath(path)
    check_output_folder(path)
    # A link is followed, and keeps being a link.
    target = os.path.realpath(path)
    # The name is there before the file, so that an interruption between the two leaves no file behind.
    temporary = os.path.join(os.path.dirname(target),
                             f".{os.path.basename(target)[:40]}.{secrets.token_hex(8)}")
    try:
        with open(os.open(temporary, os.O_RDWR | os.O_CREAT | os.O_EXCL, 0o600), "rb") as file:
            yield temporary
            os.fsync(file.fileno())
        os.chmod(temporary, _permissions(target))
        os.replace(temporary, target)
    except OSError as error:
        raise FileError(f"{path}: cannot be written: {error.strerror}") from error
    finally:
        with contextlib.suppress(OSError):
            os.unlink(temporary)


def _permissions(path):
    """Those of the file that is replaced; for a new file, those that open() gives."""
    try:
        return os.stat(path).st_mode & 0o777
    except FileNotFoundError:
        mask = os.umask(0)
        os.umask(mask)
        return 0o666 & ~mask
