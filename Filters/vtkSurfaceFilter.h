// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @class   vtkSurfaceFilter
 * @brief   superclass of the filters on triangulated surfaces: pieces, composite data, errors
 *
 * A subclass overrides ProcessSurfaces(), which gets the surfaces of the input, each in one piece,
 * with an output that already is a shallow copy, and adds its results to the outputs. This class
 * handles composite data, surfaces that are distributed over processes, progress, abort, and
 * errors, after which the output is the unchanged input.
 *
 * Polygons and strips are triangulated internally. Vertices and lines pass through. Ghost and
 * hidden cells are ignored, and so are cells with a hidden point
 * (vtkDataSetAttributes::HIDDENPOINT), which keeps its value. If that leaves nothing of a surface,
 * a warning says so. Each block of composite input is a surface of its own, and blocks of other
 * types pass through. Messages that do not hold for all blocks name theirs, by the block's name or
 * its indices, such as 0/2. Any type of input is accepted; if it has no surface, an error names the
 * type and the remedy.
 *
 * **Surfaces in pieces.** The processes of Controller (pvbatch, pvserver, MPI programs), each with
 * a piece, and the partitions of a vtkPartitionedDataSet, give the answer of the surface in one
 * piece, for any partition. All processes update together. Points of different pieces are one
 * point of the surface if they have the same global id, provided that all pieces have global ids.
 * Otherwise they are one point if they coincide within SeamTolerance and at least one of them lies
 * on the boundary of its piece. Points of one piece are never joined, which is the task of
 * MergeCoincidentPoints: the k-th coincident point of a piece is identified with the k-th of the
 * others. Data are those of the first piece that has the point. Ghost cells are ignored, and ghost
 * points get the results of the points that they are copies of. Warnings and errors are reported by
 * process 0 alone. Unless a subclass solves with the pieces themselves, the surface is gathered in
 * process 0 and the result is scattered.
 *
 * **Short edges.** The ends of an edge below 1e-10 of the longest side of one of its triangles are one
 * point of the surface, as at the seams and poles of VTK's parametric surfaces: their values are
 * combined as those of merged points. Subclasses that solve with the pieces themselves do not join
 * them.
 *
 * **Errors.** An update that reports an error fails once: GetExecutive()->Update() returns 0, and
 * filters behind this one do not execute. The output, the unchanged input (also after an abort), then
 * counts as up to date: the next update hands it on and returns 1. GetErrorCode() stays at
 * vtkErrorCode::UserError (0 after an update that succeeded or was aborted), read-only values are
 * those before the first update, and other times and pieces fail in silence, until something changes.
 *
 * @sa vtkSurfaceModelAlgorithm vtkSurfaceDiffusionAlgorithm vtkSurfaceRunAlgorithm
 */
#ifndef vtkSurfaceFilter_h
#define vtkSurfaceFilter_h

#include "Run/Sentence.h" // for messages

#include "vtkPolyDataAlgorithm.h"
#include "vtkSurfaceDiffusionModule.h" // for export macro
#include "vtkSurfaceDiffusionNamespace.h" // for VTK 9.1

#include <functional> // for steps of an update
#include <memory> // for the private part
#include <string> // for names
#include <vector> // for surfaces

namespace SurfaceDiffusion
{
class OwnedSettings;
class Reduction;
class ProgressMonitor;
class Settings;
struct SurfacePiece;
struct Warning;
}

VTK_ABI_NAMESPACE_BEGIN
class vtkMultiProcessController;
class vtkPolyData;

// A property that has the name of a setting of the class (Filters/Run), with its setter and getter.
// The setting holds the value, the default, the allowed values and, of a choice, the words. A
// setter that changes the value calls Modified(). The type is double of a number and int of an
// integer.
#define SURFACEDIFFUSION_PROPERTY(name, type)                                                      \
  virtual void Set##name(type value)                                                               \
  {                                                                                                \
    this->WriteProperty(#name, value);                                                             \
  }                                                                                                \
  virtual type Get##name() const                                                                   \
  {                                                                                                \
    type value{};                                                                                  \
    this->ReadProperty(#name, value);                                                              \
    return value;                                                                                  \
  }

// The same for a setting that is on or off.
#define SURFACEDIFFUSION_SWITCH(name)                                                              \
  SURFACEDIFFUSION_PROPERTY(name, bool)                                                            \
  virtual void name##On()                                                                          \
  {                                                                                                \
    this->Set##name(true);                                                                         \
  }                                                                                                \
  virtual void name##Off()                                                                         \
  {                                                                                                \
    this->Set##name(false);                                                                        \
  }

// Accessors of a std::string member by char pointers. The macro of VTK 9.1 takes every call for a
// change.
#define SURFACEDIFFUSION_NAME(name)                                                                \
  virtual void Set##name(const char* text)                                                         \
  {                                                                                                \
    const std::string given = text ? text : "";                                                    \
    if (this->name != given)                                                                       \
    {                                                                                              \
      this->name = given;                                                                          \
      this->Modified();                                                                            \
    }                                                                                              \
  }                                                                                                \
  vtkGetCharFromStdStringMacro(name)

// The same for a choice, which is the index of a word: one of the enumerators of the class.
#define SURFACEDIFFUSION_CHOICE(name)                                                              \
  SURFACEDIFFUSION_PROPERTY(name, int)                                                             \
  virtual const char* Get##name##AsString() const                                                  \
  {                                                                                                \
    return this->GetPropertyWord(#name);                                                           \
  }

// A read-only value of the last update: the output of this name among the numbers of the run.
#define SURFACEDIFFUSION_NUMBER(name, type)                                                        \
  virtual type Get##name() const                                                                   \
  {                                                                                                \
    return static_cast<type>(this->FindNumber(#name));                                             \
  }

class VTKSURFACEDIFFUSION_EXPORT vtkSurfaceFilter : public vtkPolyDataAlgorithm
{
public:
  vtkTypeMacro(vtkSurfaceFilter, vtkPolyDataAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /**
   * On: points within MergeTolerance of one another (in coordinate units, 0 or more, default 0) are
   * one point of the surface, as STL files and split normals need. The output keeps the input's
   * points. Off (default): coincident boundary points are counted in a warning.
   */
  SURFACEDIFFUSION_SWITCH(MergeCoincidentPoints);
  SURFACEDIFFUSION_PROPERTY(MergeTolerance, double);
  ///@}

  ///@{
  /**
   * The largest distance of points of different pieces that are one point of the surface, in
   * coordinate units. 0 or more, or -1. 0: equal coordinates only. -1 (default): 1e-6 of the
   * diagonal of the bounding box, a difference that single precision may cause. It is not used with
   * global point ids.
   */
  vtkSetMacro(SeamTolerance, double);
  vtkGetMacro(SeamTolerance, double);
  ///@}

  ///@{
  /**
   * The length above which edges are bisected before the update, in coordinate units, because large
   * triangles, as in CAD files, have no room for data. 0 or more. 0 (default, except for
   * vtkTuringTextureFilter, which also allows -1): the surface stays as it is. The longest edge is
   * always bisected next, in all its triangles at once: flat faces stay flat, sharp edges sharp,
   * and no crack opens. The output then has triangles in place of polygons and strips, with the
   * data of their cells and the cell array `vtkOriginalCellIds`, the ids of these. Data of points
   * are linear along the edges, except that integers of one component, and fixed points, seeds and
   * sources, become the smaller of two, or 0 beside 0; what is between a masked point and another
   * one is masked, and what is beside a weight of 0 has weight 0. They are no measurements, and no
   * estimate of noise counts them. Global ids, ghost cells and hidden cells are left out. With
   * MergeCoincidentPoints, copies of a point stay copies.
   */
  vtkSetMacro(RefineTo, double);
  vtkGetMacro(RefineTo, double);
  ///@}

  ///@{
  /**
   * Refinement stops before a surface, or a piece of one, has more triangles, and a warning gives
   * the length that is left. All pieces are then refined to this length. 1 or more. Default:
   * 4000000, which a texture needs about 1 GB for.
   */
  vtkSetMacro(MaximumNumberOfTriangles, int);
  vtkGetMacro(MaximumNumberOfTriangles, int);
  ///@}

  ///@{
  /**
   * The largest number of threads of an update. 0 or more; 0 (default) means all that VTK's back
   * end of vtkSMPTools has. If that back end is Sequential, as at the start of Debian's VTK and
   * ParaView, and nobody has chosen it, an update starts as many threads of its own as there are
   * processors, and ends them. With several processes it does so only if this number is greater
   * than 1. Sequential counts as chosen if the environment variable VTK_SMP_BACKEND_IN_USE is set,
   * if VTK was built with another default, or if an earlier update has found another back end. The
   * limits of vtkSMPTools::Initialize(), vtkSMPTools::LocalScope() and VTK_SMP_MAX_THREADS hold for
   * these threads, too. VTK's back end is never changed. No bit of a result depends on the number
   * of threads.
   */
  vtkSetMacro(NumberOfThreads, int);
  vtkGetMacro(NumberOfThreads, int);
  ///@}

  ///@{
  /**
   * The processes that hold pieces of the surface. Default: the global controller. Null,
   * if it was set by SetController(), means that this process has the whole surface. Otherwise an
   * update is an error if the pipeline asks for one of several pieces and no other process can be
   * reached (no MPI, or no controller of it).
   */
  virtual void SetController(vtkMultiProcessController* controller);
  vtkGetObjectMacro(Controller, vtkMultiProcessController);
  ///@}

  ///@{
  /**
   * The name of the result, and the prefix of the names of the other arrays that the filter adds.
   * Default: empty, which stands for a name that the subclass makes and no prefix, or the
   * subclass's own default. A result with the name of the array that it is computed from replaces
   * this array. If results replace other arrays of the input, a warning names these.
   */
  SURFACEDIFFUSION_NAME(ResultArrayName);
  ///@}

  /**
   * The mean length h of the distinct edges of triangles of positive area, of the last update.
   */
  SURFACEDIFFUSION_NUMBER(MeanEdgeLength, double);

  /**
   * Free the memory that the filter keeps from one update to the next: the surface and its
   * operators, factors and preconditioners of linear solvers, the current state, and the states
   * kept for GenerateTimeSteps. They let an edit of a property, or a request of another time,
   * repeat only the steps that depend on it. The next update computes all of them again, with the
   * same result. If the release-data flag of output port 0 is on, or the global one, every update
   * ends with this call. Not to be called during an update, by an observer.
   */
  virtual void ReleaseCache();

  /// After an update that failed, it follows changes of the blocks of the input, too.
  vtkMTimeType GetMTime() override;

  vtkTypeBool ProcessRequest(
    vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

protected:
  /// For a filter without settings other than those of merging points.
  vtkSurfaceFilter();
  /// settings: of the properties of the class, with their defaults.
  explicit vtkSurfaceFilter(SurfaceDiffusion::OwnedSettings settings);
  ~vtkSurfaceFilter() override;

  /// The settings, which have the values of the properties.
  SurfaceDiffusion::Settings& GetSettings() const;

  /// For tests: loops over fewer blocks of 2048 rows (default: 24) run on one thread.
  static void ShareLoopsFrom(int blocks);

  ///@{
  /// The bodies of setters and getters, for double, int and bool. A name that no setting of this
  /// type has is an error.
  template <typename T>
  void WriteProperty(const char* name, T value);
  template <typename T>
  void ReadProperty(const char* name, T& value) const;
  const char* GetPropertyWord(const char* name) const;
  ///@}

  /// A surface of the input, and its shallow copy in the output.
  struct SurfaceBlock
  {
    vtkPolyData* Input;
    vtkPolyData* Output;
    std::string Name = {}; ///< of a block of composite data, for messages; otherwise empty
  };

  /// Process the surfaces of one update and add the results to the outputs. Errors are
  /// std::runtime_error or calls of ReportProblems(); call BeginWriting() before the outputs
  /// change.
  virtual void ProcessSurfaces(
    const std::vector<SurfaceBlock>& blocks, const SurfaceDiffusion::ProgressMonitor& progress) = 0;

  /// Whether every process works on its own piece, which then is the only block. All processes give
  /// the same answer. pieces: this process's; oneSurface: whether all pieces belong to one surface
  /// and no process has several; points: their number over all processes.
  virtual bool SolvesInPieces(
    const std::vector<SurfaceBlock>& pieces, bool oneSurface, double points);

  /// The length above which edges are bisected before an update; 0: the surfaces stay as they are.
  /// meanEdgeLength: that of all surfaces if RefineTo is -1 and this is allowed; edges count once
  /// in each piece. With an explanation, a warning says that surfaces were refined. All processes
  /// give the same answer. The default returns RefineTo, unless it is no length.
  virtual double FindRefinement(
    double meanEdgeLength, SurfaceDiffusion::Sentence& explanation) const;

  /// Complete the arrays of a piece of a surface that process 0 has computed: cells that take no
  /// part are not gathered. The default does nothing.
  virtual void CompletePiece(const SurfaceBlock& piece);

  /// Declare a read-only value, which the updates take from the numbers among the outputs and which
  /// process 0 shares with all. byDefault: before the first update, after one without result, and
  /// if there is none.
  void DeclareNumber(const char* name, double byDefault = 0.0);
  /// A number of the last update, or an entry of one that is a matrix; NaN beyond its entries.
  double FindNumber(const char* name, int row = 0, int column = 0) const;

  /// Sentences that name a property or array, its value and what is allowed.
  using Problems = std::vector<SurfaceDiffusion::Sentence>;

  /// Append the problems of this class's properties.
  void CheckSurfaceProperties(Problems& problems);

  /// The blocks with polygons (all of them if processes work on pieces), and problems if there are
  /// none in any process.
  std::vector<SurfaceBlock> SelectSurfaces(
    const std::vector<SurfaceBlock>& blocks, Problems& problems) const;

  /// Report the problems of all processes as one error; false if there are none.
  bool ReportProblems(Problems problems);

  /// The last chance to abort, before outputs change. Throws SurfaceDiffusion::Aborted.
  void BeginWriting();

  /// Report, as one warning, those of the warnings that hold now that have not been reported yet.
  void ReportWarnings(std::vector<SurfaceDiffusion::Warning> warnings);

  /// The processes that work on this update together: one, unless SolvesInPieces().
  const SurfaceDiffusion::Reduction& GetProcesses() const;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int FillOutputPortInformation(int port, vtkInformation* info) override;
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector*) override;

  double SeamTolerance = -1.0;
  double RefineTo = 0.0;
  int MaximumNumberOfTriangles = 4000000;
  static constexpr double RefineAutomatically = -1.0; ///< a value of RefineTo of some
  virtual bool MayRefineAutomatically() const { return false; }
  /// The indices of the input arrays that are marks: of fixed points, seeds or sources, of any type. A
  /// point between two marked ones of a refined surface is marked, another is not.
  virtual std::vector<int> ArraysOfMarks() const { return { 3, 6 }; }
  int NumberOfThreads = 0;
  std::string ResultArrayName;

  /// What the library keeps between updates and during one; not for other subclasses.
  struct Internals;
  const std::unique_ptr<Internals> Private;

private:
  vtkSurfaceFilter(const vtkSurfaceFilter&) = delete;
  void operator=(const vtkSurfaceFilter&) = delete;

  bool RefineSurfaces(std::vector<SurfaceDiffusion::SurfacePiece>& pieces);
  bool CompleteTogether(const std::function<void()>& step);
  int RequestDataObject(vtkInformation*, vtkInformationVector**, vtkInformationVector*);
  void ProcessGuarded(const std::vector<SurfaceBlock>& blocks);
  void ReportError(const std::string& text);
  int EndUpdate();
  bool IsAborted();

  vtkMultiProcessController* Controller = nullptr;
  bool HasWholeSurface = false; ///< the meaning of a null Controller
};
VTK_ABI_NAMESPACE_END

#endif
