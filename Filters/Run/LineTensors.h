// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Core/Foundation/SymmetricModes.h"
#include "Core/Foundation/Types.h"

namespace SurfaceDiffusion
{

/// The rows u u^T of a row u.
inline Values AsTensors(const Values& lines)
{
  const Eigen::Index m = lines.cols();
  Values tensors(lines.rows(), m * m);
  for (Eigen::Index i = 0; i < lines.rows(); ++i)
  {
    Eigen::Map<Eigen::MatrixXd>(tensors.row(i).data(), m, m) =
      lines.row(i).transpose() * lines.row(i);
  }
  return tensors;
}

/// The main axis of a row of AsTensors() or of a sum of them.
template <typename Row>
Eigen::RowVectorXd MainAxis(const Row& tensor, Eigen::Index m)
{
  const Eigen::RowVectorXd copy = tensor;
  const SymmetricModes axes(Eigen::Map<const Eigen::MatrixXd>(copy.data(), m, m));
  return axes.Vectors.col(m - 1).transpose();
}

} // namespace SurfaceDiffusion
