# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Files of surfaces and of data at their vertices::

    surface = read_surface("lh.midthickness.surf.gii")  # .points (n, 3), .faces (m, 3)
    data = read_data("lh.thickness.shape.gii")          # .names, .parts[0].values (n, k)
    data.save("smooth.shape.gii", [values])             # the same format and metadata

The kind of a file is read from its content, not from its name; gzip is undone, and a file is opened
once, so that it may be a pipe. Surfaces: GIFTI, FreeSurfer, OFF, OBJ, PLY, STL, 3MF, VTK polydata and grids of
polygons (legacy and XML). Data: GIFTI, CIFTI (dscalar, dtseries), FreeSurfer (curv, mgh, mgz, NIfTI with
one voxel per vertex, label, annot), NumPy (npy), text with one number per line and comments after #, and the
vertex data of PLY and VTK. nibabel reads the formats of neuroimaging (`pip install surfacediffusion[io]`), and the
package vtk VTK files; all other formats need numpy alone.

Files are written to a temporary file in the same folder, which then replaces the output: a failed
write leaves the output as it was. Errors are FileError with one line: the file, what was found and
what is allowed.
"""
from .content import FileError, write_atomically
from .data import Data, Part, new_data, read_data
from .surface import SurfaceFile, read_surface

__all__ = ["Data", "FileError", "Part", "SurfaceFile", "new_data", "read_data", "read_surface",
           "write_atomically"]
