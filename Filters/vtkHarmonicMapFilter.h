// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkHarmonicMapFilter
 * @brief   regularise unit vectors on a triangulated surface: normals, directions, chromaticity
 *
 * Diffuses maps u from the surface into the unit sphere S^(m-1), m the number of components, 2 or
 * more: models (20) with p = 2, (21) with p = 1 and every p between of C. Wu, J. Deng and F. Chen
 * (IEEE TVCG 14(3), 2008),
 *
 *     u_t = div(g grad u) + u g |grad u|^2 + lambda 1_D (f - u),   u(0) = f / |f|,
 *     g = (|grad u|^2 + beta)^((p - 2)/2),   |grad u|^2 the sum over all components,
 *
 * with no flux over the boundary. |u| = 1 is kept to 1e-12 at every vertex. p = 2 smooths evenly;
 * p = 1 smooths within the faces of a surface and keeps its creases.
 *
 * **Data.** By default the surface's normals: the active ones, or ones computed (not split at
 * edges) where there are none. Any other point array of 2 or more components is normalised on
 * entry; only its direction counts. Vectors of length zero or with NaN are missing and filled in,
 * as are masked ones. Where InitialFill is Mean and no direction prevails (the mean of the known
 * unit vectors is shorter than 1/2, as of the normals of a closed surface), what is missing starts
 * from the rim of its hole instead. Colours (unsigned char) are regularised in chromaticity: with
 * OutputPrecision Input the result is a colour of the input's brightness |f|.
 *
 * The result becomes the active normals (UseAsNormals; only these, since ParaView takes an array
 * that is active vectors too for no normals), or else the active vectors (three components, no
 * colour) or the active scalars.
 *
 * **Energy.** The history's energy is
 *
 *     E = int ((|grad u|^2 + beta)^(p/2) - beta^(p/2)) / p + lambda/2 int 1_D |f - u|^2,
 *
 * in length^(2 - p), 4 pi for the identity of the sphere at p = 2. With AlongDiffusivity and
 * AcrossDiffusivity (D with these eigenvalues, d the larger), |grad u|^2 stands for
 * grad u . D grad u / d in E and g, and the first integral has the factor d.
 *
 * **Schemes.** TangentPlane (default) and MinimizingMovement never raise E, at any time step, on
 * any triangles; Core/HarmonicMap.h has the proof. In short: a step minimises the energy with g
 * frozen, which lies above E, over displacements orthogonal to u at every vertex; normalising then
 * brings no two vectors further apart, and where obtuse triangles give a negative coefficient, no
 * vector and another's opposite, once the matrix has been made diagonally dominant there. The
 * paper's splitting, ExplicitReaction, cannot promise it. On noisy normals TangentPlane and
 * ExplicitReaction are as accurate and as fast; at equal accuracy MinimizingMovement takes 3 to 5
 * times as long, but its result depends least on the time step.
 *
 * The unit of time in natural units is h^p (h the mean edge length), beta is in 1/h^2, lambda in
 * 1/h^p. Normals with noise of 15 degrees are at their best after a time of 0.2 to 0.4.
 *
 * There is no second-order time integrator and the sum of A_i u_i is not conserved.
 *
 * @sa vtkFVMHeatFilter vtkIntrinsicTVFilter vtkTuringTextureFilter vtkPolyDataNormals
 */
#ifndef vtkHarmonicMapFilter_h
#define vtkHarmonicMapFilter_h

#include "vtkSurfaceDataDiffusionAlgorithm.h"

class VTKSURFACEDIFFUSION_EXPORT vtkHarmonicMapFilter : public vtkSurfaceDataDiffusionAlgorithm
{
public:
  static vtkHarmonicMapFilter* New();
  vtkTypeMacro(vtkHarmonicMapFilter, vtkSurfaceDataDiffusionAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * p, in [1, 2]. 1 (default): (21), keeps creases; 2: (20), smooths evenly.
   */
  vtkSetMacro(Exponent, double);
  vtkGetMacro(Exponent, double);
  ///@}

  ///@{
  /**
   * beta in |grad u|^2 + beta, in 1/length^2 (natural: 1/h^2). Above 0; 0 is allowed with Exponent
   * 2, where beta has no effect. Default: 1e-6.
   */
  vtkSetMacro(Beta, double);
  vtkGetMacro(Beta, double);
  ///@}

  enum SchemeType
  {
    SCHEME_EXPLICIT_REACTION = 0,
    SCHEME_TANGENT_PLANE = 1,
    SCHEME_MINIMIZING_MOVEMENT = 2
  };

  ///@{
  /**
   * How a step is made. TangentPlane (default): one linear solve for displacements tangential to
   * the sphere, then normalisation; the energy never grows. MinimizingMovement: that repeated until
   * the backward Euler step is solved in full; the energy never grows. ExplicitReaction: the
   * paper's, semi-implicit diffusion of the components with one matrix, explicit reaction, then
   * normalisation.
   */
  vtkSetMacro(Scheme, int);
  vtkGetMacro(Scheme, int);
  void SetSchemeToExplicitReaction() { this->SetScheme(SCHEME_EXPLICIT_REACTION); }
  void SetSchemeToTangentPlane() { this->SetScheme(SCHEME_TANGENT_PLANE); }
  void SetSchemeToMinimizingMovement() { this->SetScheme(SCHEME_MINIMIZING_MOVEMENT); }
  const char* GetSchemeAsString();
  ///@}

  ///@{
  /**
   * Of ExplicitReaction. Off (default): the reaction u |grad u|^p as printed. On: u g |grad u|^2,
   * which balances the diffusion, so that |u| hardly drifts even without ProjectToSphere.
   */
  vtkSetMacro(ConsistentReaction, bool);
  vtkGetMacro(ConsistentReaction, bool);
  vtkBooleanMacro(ConsistentReaction, bool);
  ///@}

  ///@{
  /**
   * On (default): u/|u| after each step. Off: lengths drift; with ExplicitReaction and p = 2 they
   * run away.
   */
  vtkSetMacro(ProjectToSphere, bool);
  vtkGetMacro(ProjectToSphere, bool);
  vtkBooleanMacro(ProjectToSphere, bool);
  ///@}

  ///@{
  /**
   * On: u and -u are the same, as for principal directions. In each triangle the signs of the
   * corners are those of the smallest |grad u|; the sign that comes out means nothing. Default:
   * off.
   */
  vtkSetMacro(LineField, bool);
  vtkGetMacro(LineField, bool);
  vtkBooleanMacro(LineField, bool);
  ///@}

  ///@{
  /**
   * On (default): where the input array is the surface's normals, the result becomes the output's
   * active normals, and shading shows it at once.
   */
  vtkSetMacro(UseAsNormals, bool);
  vtkGetMacro(UseAsNormals, bool);
  vtkBooleanMacro(UseAsNormals, bool);
  ///@}

  ///@{
  /**
   * On: the points of the output are moved so that its triangles stand upright on the result (mesh
   * denoising): they minimise 1/2 int |grad(N . x)|^2 + 1/(2 r^2) int |x - x_0|^2 with N the
   * result on the triangle and r = 5 mean edge lengths. The input array must be the surface's
   * normals. Points in single precision stay so, all others become double. See GetVolumeBefore()
   * and what follows. Default: off.
   */
  vtkSetMacro(MoveVertices, bool);
  vtkGetMacro(MoveVertices, bool);
  vtkBooleanMacro(MoveVertices, bool);
  ///@}

  ///@{
  /**
   * What MoveVertices did in the last update: the area-weighted mean and the largest displacement
   * in coordinate units, and the volume enclosed before and after, signed by the orientation (of
   * blocks that are closed and consistently oriented; 0 of others). 0 where it was off.
   */
  vtkGetMacro(MeanDisplacement, double);
  vtkGetMacro(MaximumDisplacement, double);
  vtkGetMacro(VolumeBefore, double);
  vtkGetMacro(VolumeAfter, double);
  ///@}

  /**
   * In addition to the superclass: ExplicitReaction, ConsistentReaction off, ProjectToSphere on,
   * LineField and MoveVertices off. Exponent stays.
   */
  void UsePaperScheme() override;

protected:
  vtkHarmonicMapFilter();
  ~vtkHarmonicMapFilter() override;

  std::unique_ptr<SurfaceDiffusion::RunSettings> MakeSettings() const override;
  bool FindFields(
    vtkPolyData* block, SurfaceDiffusion::InputFields& fields, Problems& problems) override;
  bool CanSolveInPieces(const std::vector<SurfaceBlock>& pieces) override;
  void WriteResult(
    std::size_t index, const SurfaceDiffusion::InputFields& fields, vtkPolyData* output) override;
  void TakeResults() override;
  void VisitReported(const std::function<void(double&)>& visit) override;
  const char* GetResultSuffix() const override { return "Harmonic"; }

  double Exponent = 1.0;
  double Beta = 1e-6;
  int Scheme = SCHEME_TANGENT_PLANE;
  bool ConsistentReaction = false;
  bool ProjectToSphere = true;
  bool LineField = false;
  bool UseAsNormals = true;
  bool MoveVertices = false;
  double MeanDisplacement = 0.0;
  double MaximumDisplacement = 0.0;
  double VolumeBefore = 0.0;
  double VolumeAfter = 0.0;

private:
  vtkHarmonicMapFilter(const vtkHarmonicMapFilter&) = delete;
  void operator=(const vtkHarmonicMapFilter&) = delete;

  /// Whether no array is requested by name or as an attribute other than normals.
  bool UsesNormals();
  vtkDataArray* FindComputedNormals(vtkPolyData* block);
  bool IsNormals(const SurfaceDiffusion::InputFields& fields, vtkPolyData* block) const;
};

#endif
