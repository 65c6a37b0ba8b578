# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Reads files into memory, recognises their kind, and writes files atomically."""
from __future__ import annotations

import contextlib
import gzip
import importlib
import os
import re
import struct
import tempfile
import zlib
from dataclasses import dataclass

NAMES = {
    "gifti": "GIFTI", "cifti": "CIFTI", "nifti": "NIfTI (a volume)", "mgh": "FreeSurfer mgh",
    "freesurfer": "FreeSurfer surface", "curv": "FreeSurfer curv", "label": "FreeSurfer label",
    "off": "OFF", "obj": "OBJ", "ply": "PLY", "stl": "STL", "vtk": "VTK legacy", "vtp": "VTK XML",
    "npy": "NumPy npy",
}

# The ends of names by which an output that is named like another format is noticed.
EXTENSIONS = {
    ".gii": "gifti", ".mgh": "mgh", ".mgz": "mgh", ".label": "label", ".off": "off", ".obj": "obj",
    ".ply": "ply", ".stl": "stl", ".vtk": "vtk", ".vtp": "vtp", ".npy": "npy", ".nii": "cifti",
}


class FileError(ValueError):
    """A file that cannot be read or written; one line that names it."""


@dataclass
class Content:
    path: str
    bytes: bytes
    kind: str

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
            data = file.read()
    except OSError as error:
        raise FileError(f"{path}: cannot be read: {error.strerror}") from error
    if data[:2] == b"\x1f\x8b":
        try:
            data = gzip.decompress(data)
        except (EOFError, OSError, zlib.error) as error:
            raise FileError(f"{path}: damaged gzip file: {error}") from error
    if not data:
        raise FileError(f"{path}: the file is empty")
    kind = find_kind(data)
    if kind is None:
        raise FileError(f"{path}: a file of unknown kind that starts with {data[:12]!r}; allowed: "
                        + ", ".join(name for kind, name in NAMES.items() if kind != "nifti"))
    return Content(path, data, kind)


def find_kind(data: bytes) -> str | None:
    """The kind of a file with this content, a key of NAMES; None if unknown."""
    head = data[:4096]
    starts = {
        b"\xff\xff\xfe": "freesurfer", b"\xff\xff\xfd": "freesurfer", b"\xff\xff\xff": "curv",
        b"#!ascii label": "label", b"# vtk DataFile": "vtk", b"\x93NUMPY": "npy",
    }
    for start, kind in starts.items():
        if head.startswith(start):
            return kind
    if re.match(rb"ply\s", head):
        return "ply"
    if re.match(rb"\s*(<\?xml|<!DOCTYPE|<GIFTI|<VTKFile)", head):
        return "gifti" if b"<GIFTI" in head else "vtp" if b"<VTKFile" in head else None
    if re.match(rb"\s*(#[^\n]*\n\s*)*(ST)?C?N?OFF\b", head):
        return "off"
    return _find_binary_kind(data) or _find_text_kind(head)


def _find_binary_kind(data):
    if len(data) >= 4 and any(
            struct.unpack_from(order + "i", data)[0] == 540 for order in "<>"):
        return "cifti"
    if len(data) >= 348 and data[344:347] in (b"n+1", b"ni1"):
        return "nifti"
    if len(data) >= 284 and struct.unpack_from(">i", data)[0] == 1:
        return "mgh"
    if len(data) >= 84 and len(data) == 84 + 50 * struct.unpack_from("<I", data, 80)[0]:
        return "stl"
    return None


def _find_text_kind(head):
    if re.match(rb"\s*solid\b", head):
        return "stl"
    if b"\0" not in head and re.search(rb"^v\s+[-+.\d]", head, re.MULTILINE):
        return "obj"
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
        yield
    except FileError:
        raise
    except Exception as error:
        reason = " ".join(str(error).split()) or type(error).__name__
        raise content.error(f"damaged {content.name} file: {reason[:200]}") from error


def kind_of_name(path) -> str | None:
    """The kind that the name of an output file announces; None if it announces none."""
    name = os.fspath(path).lower()
    if name.endswith(".gz"):
        name = name[:-3]
    return EXTENSIONS.get(os.path.splitext(name)[1])


def check_output_name(path, kind):
    """An output is written in the format of the input, so its name must not say otherwise."""
    announced = kind_of_name(path)
    if announced not in (None, kind):
        raise FileError(f"{path}: named as {NAMES[announced]}, but it is written as {NAMES[kind]}, "
                        "the format of the input")


def check_output_folder(path):
    """Finds before a long computation that its result has no place to go."""
    folder = os.path.dirname(os.path.abspath(path))
    if not os.path.isdir(folder):
        raise FileError(f"{path}: cannot be written: there is no folder {folder}")
    if os.path.isdir(path):
        raise FileError(f"{path}: cannot be written: it is a folder")
    if os.path.exists(path) and not os.path.isfile(path):  # a device or a pipe would be replaced
        raise FileError(f"{path}: cannot be written: it is not a regular file")
    if not os.access(folder, os.W_OK):
        raise FileError(f"{path}: cannot be written: no permission to write in {folder}")


def write_atomically(path, data: bytes):
    """Writes `data`, compressed if the name ends in .gz or .mgz. The output appears complete or
    not at all: a temporary file beside it is renamed."""
    path = os.fspath(path)
    check_output_folder(path)
    if path.lower().endswith((".gz", ".mgz")):
        data = gzip.compress(data, 1, mtime=0)  # as nibabel: floats hardly shrink more
    # A link is followed, and keeps being a link.
    target = os.path.realpath(path)
    temporary = None
    try:
        handle, temporary = tempfile.mkstemp(
            dir=os.path.dirname(target), prefix="." + os.path.basename(target) + ".")
        with open(handle, "wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        os.chmod(temporary, _permissions(target))
        os.replace(temporary, target)
    except OSError as error:
        raise FileError(f"{path}: cannot be written: {error.strerror}") from error
    finally:
        if temporary is not None and os.path.exists(temporary):
            os.unlink(temporary)


def _permissions(path):
    """Those of the file that is replaced; for a new file, those that open() gives."""
    try:
        return os.stat(path).st_mode & 0o777
    except FileNotFoundError:
        mask = os.umask(0)
        os.umask(mask)
        return 0o666 & ~mask
