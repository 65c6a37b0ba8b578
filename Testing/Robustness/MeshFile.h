// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "vtkCellArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

/// Reads an OFF file without its colours. Unlike in the core's MeshFiles.h, polygons are not cut
/// into triangles.
inline vtkSmartPointer<vtkPolyData> ReadOFF(const std::string& path)
{
  std::ifstream file(path);
  std::istringstream text;
  const auto nextLine = [&]
  {
    for (std::string line; std::getline(file, line);)
    {
      line.erase(std::min(line.find('#'), line.size())); // a comment
      if (line.find_first_not_of(" \t\r") != std::string::npos)
      {
        text.clear();
        text.str(line);
        return;
      }
    }
    throw std::runtime_error("the mesh file " + path + " ends too early");
  };
  std::string format;
  nextLine();
  text >> format;
  if (format != "OFF" && format != "COFF")
  {
    throw std::runtime_error(path + " is no mesh file of a kind known here");
  }
  vtkIdType points = 0;
  vtkIdType polygons = 0;
  nextLine();
  text >> points >> polygons;
  vtkNew<vtkPoints> places;
  places->SetDataTypeToDouble();
  for (vtkIdType i = 0; i < points; ++i)
  {
    double p[3] = { 0.0, 0.0, 0.0 };
    nextLine();
    text >> p[0] >> p[1] >> p[2];
    places->InsertNextPoint(p);
  }
  vtkNew<vtkCellArray> cells;
  for (vtkIdType c = 0; c < polygons; ++c)
  {
    std::size_t count = 0;
    nextLine();
    text >> count;
    std::vector<vtkIdType> corners(count);
    for (vtkIdType& corner : corners)
    {
      text >> corner;
    }
    if (!text)
    {
      throw std::runtime_error("a polygon of the mesh file " + path + " cannot be read");
    }
    cells->InsertNextCell(static_cast<vtkIdType>(count), corners.data());
  }
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  surface->SetPoints(places);
  surface->SetPolys(cells);
  return surface;
}
