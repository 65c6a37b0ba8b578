// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfaceModelAlgorithm
 * @brief   superclass of the models of arrays on surfaces: arrays, units, masks, results
 *
 * The subclasses solve equations on triangulated surfaces by the finite volume method of
 * C. Wu, J. Deng, F. Chen, "Diffusion Equations over Arbitrary Triangulated Surfaces for Filtering
 * and Texture Applications", IEEE TVCG 14(3), 2008: the Laplace-Beltrami operator is discretised
 * with cotan weights and a lumped mass matrix, whose entries are the areas A_i of barycentric
 * control cells. The surface may have any angles and any topology. Data on points are piecewise
 * linear on the triangles; data on cells are moved to the points first, see below. The boundary
 * condition is the homogeneous Neumann condition: there is no flux over the boundary of the
 * surface.
 *
 * **Input arrays**, `SetInputArrayToProcess(idx, 0, 0, association, name)`; an empty name means
 * that the array is not set:
 *
 * | idx | association | meaning |
 * | --- | --- | --- |
 * | 0 | points or cells | the data f, of any numeric type and number of components |
 * | 1 | points or cells | the mask, one component: nonzero is missing or excluded, see MaskMode |
 * | 2 | points or cells | the direction e1, three components, up to its sign |
 * | 3 | points or cells | nonzero: the value is held fixed (Dirichlet) |
 *
 * Unsigned chars are colours: the last of 2 or 4 components is alpha and is copied. The default
 * data are the active scalars of the points, or, if there are none, of the cells. A point is also
 * missing if any component of f is NaN. Directions are projected into each triangle and normalised,
 * and e2 = n x e1; a triangle whose direction is zero or NaN is isotropic, with the geometric mean
 * of the two diffusivities. A point that is both fixed and missing is fixed.
 *
 * Nothing determines values on a connected component of the surface without a known value. It takes
 * no part: its result is NaN if the data are floating-point numbers and the input if they are
 * integers, regions of a segmentation have the label 0 and edges of vtkMumfordShahFilter are 0
 * there. One warning counts these components. Data without any known value are an error. (Textures
 * need no data.) Fixed points, and the seeds of a segmentation, count as known.
 *
 * **Data on cells**, that is on triangles, quadrilaterals, larger polygons and strips, go to the
 * points, are processed there, and their change comes back. With the area m_ci that cell c and the
 * control cell of point i have in common, the area A_c of the cell, and
 *
 *     (P f)_i  = sum over c of m_ci f_c / A_i,
 *     (P* u)_c = sum over i of m_ci u_i / A_c,
 *
 * the run starts from u_0 = P f, and the result on the cells is P* u + d with the detail d that the
 * points do not resolve. It starts as d_0 = f - P* u_0 and diffuses, too: each step of a model with
 * the diffusion tensor D solves
 *
 *     (A + dt L + dt lambda w chi A) d_new = A (d + dt lambda w chi d_0)
 *
 * on the cells, which is backward Euler with the two-point fluxes L between neighbours: |e| D over
 * the distance of their centres by way of the middle of their edge e, times d_c - d_c'. A step to a
 * steady state is its limit for long dt. So noise of single cells leaves as noise at points does,
 * zero steps return f bit by bit, and where the points keep the range of f the result does: what
 * would leave it is spread over the component. P and P* keep constants and the integral, sum of
 * A_c f_c = sum of A_i u_i. Cells of several triangles have equal shares of their area for their
 * corners in P, and a constant restores the integral, so that results depend on the diagonals by
 * O(h^2) only. A cell is missing if it is masked or NaN, and a point if all cells around it are;
 * missing cells have d_0 = 0. With data on cells, a cell of a masked point is masked. With data on
 * points, the points of a masked cell are masked. The points of a fixed cell are fixed to the mean
 * of the fixed cells around them, and its d stays. Ghost cells and cells that are no polygons keep
 * their value.
 *
 * Composite input is one problem with one set of units; see vtkSurfaceFilter for composite data and
 * for surfaces in pieces. A block without the data, or with data that are not allowed, passes
 * through, and another array that a block does not have counts as not set there, if at least one
 * block has it. One warning names these blocks. Each process solves with its piece, so that memory
 * and time are divided, if the surface has one piece per process, IntrinsicDelaunay and
 * MergeCoincidentPoints are off, and Solver is ConjugateGradient or Multigrid, or Automatic with
 * more than 10,000 points. An abort is then obeyed by all processes within a few iterations.
 * Some features are always computed in process 0, which then holds the whole surface:
 * AutomaticFidelity, Discretization CrouzeixRaviart of vtkIntrinsicTVFilter, EdgeCurves and
 * AutomaticThreshold of vtkMumfordShahFilter, and MoveVertices, computed normals and line fields
 * with missing values of vtkHarmonicMapFilter. Random numbers are those of one process if there are
 * global ids; otherwise they depend on the coordinates.
 *
 * **Output port 0** is the input with the result as a further array, made active, of points or, for
 * data on cells, of cells. Points that no participating triangle uses keep their value. **Output
 * port 1** is a vtkTable, whose rows each class documents.
 *
 * **Invalid properties or arrays** are errors at update that name the property, its value and what
 * is allowed. The output then is the unchanged input. Defects of the surface (zero-area triangles,
 * non-manifold edges, coincident points) are handled and reported in one warning with counts;
 * NumberOfUnusedPoints counts the points of no triangle. A warning is repeated only if the arrays
 * or the surface that it is about have changed.
 *
 * Results do not depend on the number of threads.
 *
 * A class whose result depends on time derives from vtkSurfaceDiffusionAlgorithm. This class has no
 * time: its result is a steady state, and the time of the input passes through.
 *
 * @sa vtkSurfaceFilter vtkSurfaceDiffusionAlgorithm vtkSurfaceSegmentationFilter
 */
#ifndef vtkSurfaceModelAlgorithm_h
#define vtkSurfaceModelAlgorithm_h

#include "vtkSurfaceFilter.h"

namespace SurfaceDiffusion
{
struct BlockInput;
struct InputFields;
struct RunSettings;
}

VTK_ABI_NAMESPACE_BEGIN
class vtkPolyData;

class VTKSURFACEDIFFUSION_EXPORT vtkSurfaceModelAlgorithm : public vtkSurfaceFilter
{
public:
  vtkTypeMacro(vtkSurfaceModelAlgorithm, vtkSurfaceFilter);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  enum UnitsType
  {
    UNITS_NATURAL = 0,
    UNITS_ABSOLUTE = 1
  };

  ///@{
  /**
   * The units of times, weights and thresholds. Absolute: the units of the coordinates and of the
   * array. Natural (default): lengths are in h, the mean length of the distinct edges of triangles
   * of positive area, and values are in R, the largest over the components of max - min of the
   * known values (1 if that is 0), so that one setting suits any mesh and any array. Classes
   * with time document its unit; see also vtkSurfaceDiffusionAlgorithm::GetTimeUnit().
   *
   * Edges longer than 30 times the median edge do not count in h, and values on at most 1 % of the
   * area do not count in R where the range of the others is at most a tenth of the whole one, but
   * not 0: spikes and outliers are no units. Either is one warning.
   */
  SURFACEDIFFUSION_CHOICE(Units);
  void SetUnitsToNatural() { this->SetUnits(UNITS_NATURAL); }
  void SetUnitsToAbsolute() { this->SetUnits(UNITS_ABSOLUTE); }
  ///@}

  enum MaskModeType
  {
    MASK_MODE_INPAINT = 0,
    MASK_MODE_EXCLUDE = 1
  };

  ///@{
  /**
   * The meaning of the mask. Inpaint (default): masked points are missing and are filled in, (18)
   * and (19). Exclude: triangles with a masked vertex and masked cells are ignored, there is no
   * flux over the edges of the remaining region of interest, and masked points and cells keep their
   * value.
   */
  SURFACEDIFFUSION_CHOICE(MaskMode);
  void SetMaskModeToInpaint() { this->SetMaskMode(MASK_MODE_INPAINT); }
  void SetMaskModeToExclude() { this->SetMaskMode(MASK_MODE_EXCLUDE); }
  ///@}

  /**
   * The seed of all random numbers. A random number is a hash of the seed, the component and the
   * point's global id. Without global ids, its coordinates take the place of the id, and the rank
   * among coincident points. So it is the same on all machines, in one process and in several.
   * Default: 0.
   */
  SURFACEDIFFUSION_PROPERTY(RandomSeed, int);

  /**
   * On: the equations are solved on the intrinsic Delaunay triangulation of the same surface. No
   * vertex moves; edges are flipped along geodesics, on a double cover of the surface if it has a
   * boundary or is not a manifold (N. Sharp, K. Crane, SGP 2020). Linear diffusion with FirstOrder
   * then keeps the bounds of the data at any time step on any surface. Default: off.
   */
  SURFACEDIFFUSION_SWITCH(IntrinsicDelaunay);

  enum OutputPrecisionType
  {
    OUTPUT_PRECISION_SINGLE = vtkAlgorithm::SINGLE_PRECISION,
    OUTPUT_PRECISION_DOUBLE = vtkAlgorithm::DOUBLE_PRECISION,
    OUTPUT_PRECISION_INPUT = vtkAlgorithm::DEFAULT_PRECISION
  };

  ///@{
  /**
   * The type of the result, with the numbers of vtkAlgorithm's precisions: Single 0, Double 1,
   * Input 2. All arithmetic is in double precision. Input (default): unsigned char gives unsigned
   * char (rounded and clamped at the end, never between steps), float gives float, and all other
   * types give double.
   */
  vtkSetMacro(OutputPrecision, int);
  vtkGetMacro(OutputPrecision, int);
  void SetOutputPrecisionToInput() { this->SetOutputPrecision(OUTPUT_PRECISION_INPUT); }
  void SetOutputPrecisionToSingle() { this->SetOutputPrecision(OUTPUT_PRECISION_SINGLE); }
  void SetOutputPrecisionToDouble() { this->SetOutputPrecision(OUTPUT_PRECISION_DOUBLE); }
  const char* GetOutputPrecisionAsString();
  ///@}

  void ReleaseCache() override;

  ///@{
  /**
   * Values of the last update: R of natural units, the sum of the iterations of all solves, their
   * largest relative residual, and the number of points that no triangle uses and that keep their
   * values (without those that the mask excludes).
   */
  SURFACEDIFFUSION_NUMBER(ValueRange, double);
  SURFACEDIFFUSION_NUMBER(NumberOfIterations, vtkIdType);
  SURFACEDIFFUSION_NUMBER(Residual, double);
  SURFACEDIFFUSION_NUMBER(NumberOfUnusedPoints, vtkIdType);
  ///@}

protected:
  /// settings: of a class derived from SurfaceDiffusion::RunSettings.
  explicit vtkSurfaceModelAlgorithm(SurfaceDiffusion::OwnedSettings settings);
  ~vtkSurfaceModelAlgorithm() override;

  SurfaceDiffusion::RunSettings& GetRunSettings() const;

  /// Find and check the arrays of a block. False: the block has no data and passes through.
  virtual bool FindFields(
    vtkPolyData* block, SurfaceDiffusion::InputFields& fields, Problems& problems);

  void ProcessSurfaces(const std::vector<SurfaceBlock>& blocks,
    const SurfaceDiffusion::ProgressMonitor& progress) override;
  bool SolvesInPieces(
    const std::vector<SurfaceBlock>& pieces, bool oneSurface, double points) override;
  void CompletePiece(const SurfaceBlock& piece) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  int OutputPrecision = OUTPUT_PRECISION_INPUT;

  /// The run, kept between updates; not for subclasses outside of this library.
  struct UpdateState;
  const std::unique_ptr<UpdateState> State;

private:
  vtkSurfaceModelAlgorithm(const vtkSurfaceModelAlgorithm&) = delete;
  void operator=(const vtkSurfaceModelAlgorithm&) = delete;

  void FindAllFields(const std::vector<SurfaceBlock>& blocks, std::vector<SurfaceBlock>& surfaces,
    std::vector<SurfaceDiffusion::InputFields>& fields, Problems& problems);
  int FindResultType(const SurfaceDiffusion::InputFields& fields) const;
  void WriteResult(
    std::size_t index, const SurfaceDiffusion::InputFields& fields, vtkPolyData* output);
  void TakeNumbers();
  void MakeTables();
  void WriteFidelityWeights(const std::vector<SurfaceBlock>& surfaces);
  void WriteResults(const std::vector<SurfaceBlock>& surfaces,
    const std::vector<SurfaceDiffusion::InputFields>& fields);
  std::vector<SurfaceDiffusion::BlockInput> MakeInputs(
    const std::vector<SurfaceDiffusion::InputFields>& surfaces);
};
VTK_ABI_NAMESPACE_END

#endif
