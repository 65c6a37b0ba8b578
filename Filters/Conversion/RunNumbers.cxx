// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "Conversion/RunNumbers.h"

#include "vtkMultiProcessStream.h"

#include <limits>

namespace SurfaceDiffusion
{

double RunNumbers::Find(const std::string& name, int row, int column) const
{
  constexpr double NaN = std::numeric_limits<double>::quiet_NaN();
  const auto number = this->Found.find(name);
  if (number == this->Found.end())
  {
    const auto byDefault = this->Defaults.find(name);
    return byDefault == this->Defaults.end() ? NaN : byDefault->second;
  }
  const Values& matrix = number->second;
  const bool isInside = row >= 0 && row < matrix.rows() && column >= 0 && column < matrix.cols();
  return isInside ? matrix(row, column) : NaN;
}

void RunNumbers::Share(const Processes& processes)
{
  if (processes.Count() == 1)
  {
    return;
  }
  vtkMultiProcessStream stream;
  stream << static_cast<int>(this->Found.size());
  for (const auto& [name, matrix] : this->Found)
  {
    stream << name << static_cast<int>(matrix.rows()) << static_cast<int>(matrix.cols());
    for (Eigen::Index i = 0; i < matrix.size(); ++i)
    {
      stream << matrix.data()[i];
    }
  }
  processes.Controller()->Broadcast(stream, 0);
  int count = 0;
  stream >> count;
  this->Found.clear();
  for (int n = 0; n < count; ++n)
  {
    std::string name;
    int rows = 0;
    int columns = 0;
    stream >> name >> rows >> columns;
    Values& matrix = this->Found[name];
    matrix.resize(rows, columns);
    for (Eigen::Index i = 0; i < matrix.size(); ++i)
    {
      stream >> matrix.data()[i];
    }
  }
}

} // namespace SurfaceDiffusion
