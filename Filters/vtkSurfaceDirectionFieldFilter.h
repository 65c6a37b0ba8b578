// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfaceDirectionFieldFilter
 * @brief   makes fields of directions on a surface, as cell data
 *
 * The anisotropic diffusion filters take one direction per cell or point, as a line: its sign does
 * not matter. This filter makes such fields, as unit vectors in the cell array `Direction`, made
 * active; zero where there is no direction (the diffusion filters are isotropic there).
 *
 * - PrincipalCurvature: along which the surface bends least (Minimum) or most (Maximum), from the
 *   derivative of the normals, which the heat equation smooths first over SmoothingLength.
 * - CurvatureAligned: the same where the surface bends distinctly, joined smoothly elsewhere.
 * - Smooth: the line field that turns least over the whole surface, the lowest mode of the
 *   connection Laplacian (F. Knoppel, K. Crane, U. Pinkall, P. Schroder, Globally Optimal Direction
 *   Fields, ACM Trans. Graph. 32(4), 2013). Of equally smooth ones the one nearest to the direction
 *   of principal curvature.
 * - Hints: smooth, and near the directions of input array 2 where it has any.
 *
 * A line at angle a is the complex number z = exp(2 i a). CurvatureAligned and Hints minimise
 *
 *     int |grad z|^2 + int w |z - z_hint|^2,    w = HintWeight / h^2,
 *
 * h the mean edge length; for CurvatureAligned w is multiplied by the difference of the principal
 * curvatures' sizes over its mean. Discretised with Crouzeix-Raviart elements (O. Stein, M.
 * Wardetzky, A. Jacobson, E. Grinspun, A Simple Discretization of the Vector Dirichlet Energy, CGF
 * 39(5), 2020): any angles and any topology, orientable or not. Fields must turn around singular
 * points where the surface is curved in all (a sphere has at least four, of half a turn each).
 *
 * Input array 2 (points or cells, 3 components), for Hints: zero or NaN means no hint there, the
 * length does not matter. Connected components without a hint get zero vectors.
 *
 * Surfaces in pieces, over processes and partitions, are treated as vtkSurfaceDiffusionAlgorithm
 * does: the whole is solved in process 0.
 *
 * Polygons and strips get the main axis of their triangles' directions, vertices and lines zero.
 *
 * @sa vtkTuringTextureFilter vtkFVMHeatFilter vtkIntrinsicTVFilter
 */
#ifndef vtkSurfaceDirectionFieldFilter_h
#define vtkSurfaceDirectionFieldFilter_h

#include "vtkSurfaceFilter.h"

namespace SurfaceDiffusion
{
struct DirectionFieldSettings;
}

class VTKSURFACEDIFFUSION_EXPORT vtkSurfaceDirectionFieldFilter : public vtkSurfaceFilter
{
public:
  static vtkSurfaceDirectionFieldFilter* New();
  vtkTypeMacro(vtkSurfaceDirectionFieldFilter, vtkSurfaceFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum MethodType
  {
    METHOD_PRINCIPAL_CURVATURE = 0,
    METHOD_CURVATURE_ALIGNED = 1,
    METHOD_SMOOTH = 2,
    METHOD_HINTS = 3
  };

  ///@{
  /**
   * How the field is made, see above. Default: PrincipalCurvature.
   */
  vtkSetMacro(Method, int);
  vtkGetMacro(Method, int);
  void SetMethodToPrincipalCurvature() { this->SetMethod(METHOD_PRINCIPAL_CURVATURE); }
  void SetMethodToCurvatureAligned() { this->SetMethod(METHOD_CURVATURE_ALIGNED); }
  void SetMethodToSmooth() { this->SetMethod(METHOD_SMOOTH); }
  void SetMethodToHints() { this->SetMethod(METHOD_HINTS); }
  const char* GetMethodAsString();
  ///@}

  enum PrincipalDirectionType
  {
    PRINCIPAL_DIRECTION_MINIMUM = 0,
    PRINCIPAL_DIRECTION_MAXIMUM = 1
  };

  ///@{
  /**
   * The direction of principal curvature: Minimum (default), along which the surface bends least (a
   * cylinder's axis), or Maximum, perpendicular to it. Curvatures count by their size.
   */
  vtkSetMacro(PrincipalDirection, int);
  vtkGetMacro(PrincipalDirection, int);
  void SetPrincipalDirectionToMinimum()
  {
    this->SetPrincipalDirection(PRINCIPAL_DIRECTION_MINIMUM);
  }
  void SetPrincipalDirectionToMaximum()
  {
    this->SetPrincipalDirection(PRINCIPAL_DIRECTION_MAXIMUM);
  }
  const char* GetPrincipalDirectionAsString();
  ///@}

  ///@{
  /**
   * Full width at half maximum of the Gaussian that smooths the normals before their derivative is
   * taken, in coordinate units; 0: none, -1 (default): four mean edge lengths.
   */
  vtkSetMacro(SmoothingLength, double);
  vtkGetMacro(SmoothingLength, double);
  ///@}

  ///@{
  /**
   * How much hints and curvatures weigh against smoothness, in 1/h^2 with h the mean edge length:
   * the field follows changes of the hints over lengths down to about h/sqrt(HintWeight). Above 0.
   * Default: 0.1.
   */
  vtkSetMacro(HintWeight, double);
  vtkGetMacro(HintWeight, double);
  ///@}

  ///@{
  /**
   * By how many degrees the field is turned in the surface at the end, counter-clockwise about the
   * normals of the cells. Default: 0.
   */
  vtkSetMacro(Angle, double);
  vtkGetMacro(Angle, double);
  ///@}

protected:
  vtkSurfaceDirectionFieldFilter();
  ~vtkSurfaceDirectionFieldFilter() override;

  void ProcessSurfaces(const std::vector<SurfaceBlock>& blocks,
    const SurfaceDiffusion::ProgressMonitor& progress) override;

  int Method = METHOD_PRINCIPAL_CURVATURE;
  int PrincipalDirection = PRINCIPAL_DIRECTION_MINIMUM;
  double SmoothingLength = -1.0;
  double HintWeight = 0.1;
  double Angle = 0.0;

private:
  vtkSurfaceDirectionFieldFilter(const vtkSurfaceDirectionFieldFilter&) = delete;
  void operator=(const vtkSurfaceDirectionFieldFilter&) = delete;

  std::unique_ptr<SurfaceDiffusion::DirectionFieldSettings> MakeSettings() const;

  /// The fields, kept between updates.
  struct RunState;
  const std::unique_ptr<RunState> State;
};

#endif
