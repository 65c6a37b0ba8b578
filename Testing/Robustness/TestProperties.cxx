// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Every property of every filter changes alone between two updates, with settings for which it
// has an effect. The second result differs from the first and is that of a new filter with the same
// settings, bit for bit. A class with a property that these tests do not set fails, too.

#include "Twins.h"

#include "vtkCellArray.h"
#include "vtkMath.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

using namespace FilterTest;

namespace
{

/// Properties without a visible effect here: they concern memory, threads or several processes,
/// select among solvers with the same result, or only lead to errors or apply to negative
/// concentrations.
const std::set<std::string> WithoutEffect = { "CheckpointMemoryLimit", "Controller",
  "NumberOfThreads", "SeamTolerance", "Solver", "Tolerance", "MaximumNumberOfIterations",
  "ClampToNonNegative" };
const std::set<std::string> WithoutEffectInClass = {
  "vtkHarmonicMapFilter TimeIntegrator", // it has only one
  "vtkMumfordShahFilter EdgeCurves", // three steps find no edge that is long enough
  "vtkSurfaceSegmentationFilter RandomSeed", // the best of several starts
  "vtkSurfaceInterpolationFilter MaximumDistance", // of points on the second input
  "vtkSurfaceDistanceFilter MaximumDistance", // likewise
  "vtkSurfaceInterpolationFilter MissingValue", // which no value is
  "vtkSurfaceInterpolationFilter PointValueArray", "vtkSurfaceInterpolationFilter PointWeightArray",
  "vtkSurfaceInterpolationFilter RandomSeed", // of more values than the surface has
};

/// An ellipsoid with obtuse triangles. One patch has points of its own: the others are at most 0.01
/// away.
vtkSmartPointer<vtkPolyData> PatchedEllipsoid()
{
  auto surface = Sphere(2);
  vtkPoints* const points = surface->GetPoints();
  for (vtkIdType i = 0; i < points->GetNumberOfPoints(); ++i)
  {
    double p[3];
    points->GetPoint(i, p);
    points->SetPoint(i, p[0], 3.0 * p[1] + 0.5 * p[0], 0.4 * p[2]);
  }
  vtkNew<vtkCellArray> cells;
  std::map<vtkIdType, vtkIdType> copies;
  for (vtkIdType c = 0; c < surface->GetNumberOfCells(); ++c)
  {
    vtkNew<vtkIdList> corners;
    surface->GetCellPoints(c, corners);
    for (vtkIdType a = 0; c < 16 && a < 3; ++a)
    {
      const vtkIdType point = corners->GetId(a);
      if (!copies.count(point))
      {
        double p[3];
        points->GetPoint(point, p);
        p[2] += copies.size() % 2 ? 0.01 : 0.0;
        copies[point] = points->InsertNextPoint(p);
      }
      corners->SetId(a, copies[point]);
    }
    cells->InsertNextCell(corners);
  }
  surface->SetPolys(cells);
  AddPointArray(surface, "f", 3, [](vtkIdType i, int k) { return 2.0 + Rough(i, k); });
  AddPointArray(
    surface, "bytes", 3, [](vtkIdType i, int k) { return std::floor(127.0 + 120.0 * Rough(i, k)); },
    VTK_UNSIGNED_CHAR);
  AddPointArray(surface, "mask", 1, [](vtkIdType i, int) { return i % 7 == 3; });
  AddPointArray(surface, "few", 1, [](vtkIdType i, int) { return i % 7 == 5 && i < 40; });
  AddPointArray(surface, "height", 1, [](vtkIdType i, int k) { return 2.0 + Rough(i, k); });
  surface->GetCellData()->AddArray(MakeArray(VTK_DOUBLE, "c", surface->GetNumberOfCells(), 3,
    [](vtkIdType i, int k) { return 2.0 + Rough(i, k); }));
  AddPointArray(surface, "e1", 3, [](vtkIdType, int k) { return k == 1 ? 1.0 : 0.3; });
  surface->GetPointData()->SetActiveScalars("f");
  return surface;
}

/// Settings with which a property has an effect, by its name or by class and name.
template <typename F>
std::function<void(vtkPolyDataAlgorithm*)> With(void (*set)(F*))
{
  return [set](vtkPolyDataAlgorithm* filter) { set(static_cast<F*>(filter)); };
}

std::map<std::string, std::function<void(vtkPolyDataAlgorithm*)>> NeededSettings()
{
  using Surface = vtkSurfaceFilter;
  using Diffusion = vtkSurfaceDiffusionAlgorithm;
  using Data = vtkSurfaceDataDiffusionAlgorithm;
  using Heat = vtkFVMHeatFilter;
  using TV = vtkIntrinsicTVFilter;
  using Harmonic = vtkHarmonicMapFilter;
  using Turing = vtkTuringTextureFilter;
  using Direction = vtkSurfaceDirectionFieldFilter;
  using Segmentation = vtkSurfaceSegmentationFilter;
  using Spline = vtkSurfaceInterpolationFilter;
  using Shah = vtkMumfordShahFilter;
  using Tensor = vtkTensorDiffusionFilter;
  using Denoising = vtkSurfaceDenoisingFilter;
  std::map<std::string, std::function<void(vtkPolyDataAlgorithm*)>> needed;
  needed["MergeTolerance"] = With<Surface>([](Surface* f) { f->MergeCoincidentPointsOn(); });
  needed["OutputInterval"] = With<Diffusion>([](Diffusion* f) { f->GenerateTimeStepsOn(); });
  for (const char* name : { "vtkFVMHeatFilter", "vtkIntrinsicTVFilter", "vtkHarmonicMapFilter",
         "vtkMumfordShahFilter", "vtkTensorDiffusionFilter" })
  {
    needed[name + std::string(" RandomSeed")] =
      With<Data>([](Data* f) { f->SetInitialFillToNoise(); });
  }
  needed["ResultOnCells"] =
    needed["KeepCellDetail"] = [](vtkPolyDataAlgorithm* f) { SetInputArray(f, 0, "c", true); };
  needed["vtkSurfaceDenoisingFilter SurfaceType"] =
    needed["vtkSurfaceDenoisingFilter MergeCoincidentPoints"] =
      needed["vtkSurfaceDenoisingFilter MergeTolerance"] = needed["NoiseLength"] =
        needed["CreaseAngle"] = needed["DisplacementLimit"] =
          With<Denoising>([](Denoising* f) { f->SetNoiseLevel(0.1); });
  for (const char* name : { "Threshold", "Flank" })
  {
    needed[name] = With<vtkSurfaceReliefFilter>(
      [](vtkSurfaceReliefFilter* f)
      {
        f->SetHeight(0.03);
        f->SetThreshold(2.0);
        f->SetLevelsToTwo();
      });
  }
  needed["vtkSurfaceReliefFilter Base"] = needed["Levels"] = needed["Overhang"] =
    needed["vtkSurfaceReliefFilter RefineTo"] = needed["vtkSurfaceReliefFilter ResultArrayName"] =
      needed["vtkSurfaceReliefFilter MaximumNumberOfTriangles"] =
        needed["vtkSurfaceReliefFilter MergeCoincidentPoints"] =
          needed["vtkSurfaceReliefFilter MergeTolerance"] =
            With<vtkSurfaceReliefFilter>([](vtkSurfaceReliefFilter* f) { f->SetHeight(0.03); });
  needed["MaximumNumberOfTriangles"] =
    With<vtkSurfaceFilter>([](vtkSurfaceFilter* f) { f->SetRefineTo(0.3); });
  needed["UpDirection"] = With<vtkSurfaceReliefFilter>(
    [](vtkSurfaceReliefFilter* f)
    {
      f->SetHeight(0.03);
      f->SetOverhang(45.0);
    });
  for (const char* name : { "AlongSpeed", "AcrossSpeed" })
  {
    needed[name] =
      With<vtkSurfaceDistanceFilter>([](vtkSurfaceDistanceFilter* f) { f->SetMethodToEikonal(); });
  }
  needed["vtkSurfaceRandomFieldFilter Range"] = With<vtkSurfaceRandomFieldFilter>(
    [](vtkSurfaceRandomFieldFilter* f) { f->SetCovarianceToMaternNu1(); });
  needed["vtkSurfaceRandomFieldFilter Smoothness"] = With<vtkSurfaceRandomFieldFilter>(
    [](vtkSurfaceRandomFieldFilter* f) { f->SetCovarianceToMatern(); });
  needed["vtkFVMHeatFilter NoiseLevel"] = With<Heat>([](Heat* f) { f->AutomaticFidelityOn(); });
  needed["vtkIntrinsicTVFilter AutomaticFidelity"] =
    With<TV>([](TV* f) { f->SetStopTolerance(0.1); }); // it takes long otherwise
  needed["vtkIntrinsicTVFilter NoiseLevel"] = With<TV>(
    [](TV* f)
    {
      f->AutomaticFidelityOn();
      f->SetStopTolerance(0.1);
    });
  for (const char* name : { "VectorType", "VectorLaplacian", "NormalPart" })
  {
    needed[name] = With<Heat>([](Heat* f) { f->SetVectorTypeToTangent(); });
  }
  needed["vtkFVMHeatFilter BlurFWHM"] = With<Heat>(
    [](Heat* f)
    {
      f->SetModeToSteadyState();
      f->SetFidelityWeight(1.0);
    });
  needed["vtkFVMHeatFilter BlurSteps"] = With<Heat>(
    [](Heat* f)
    {
      f->SetModeToSteadyState();
      f->SetFidelityWeight(1.0);
      f->SetBlurFWHM(0.2);
    });
  needed["vtkIntrinsicTVFilter BlurFWHM"] = With<TV>([](TV* f) { f->SetModeToSteadyState(); });
  needed["vtkIntrinsicTVFilter BlurSteps"] = needed["AutomaticBlurFidelity"] = With<TV>(
    [](TV* f)
    {
      f->SetModeToSteadyState();
      f->SetBlurFWHM(0.2);
    });
  needed["Regularizer"] = With<TV>([](TV* f) { f->SetModeToSteadyState(); });
  needed["TGVLength"] = With<TV>(
    [](TV* f)
    {
      f->SetModeToSteadyState();
      f->SetRegularizerToTGV();
    });
  needed["ChromaWeight"] = With<TV>([](TV* f) { f->SetColorModelToOpponent(); });
  needed["ChromaticityExponent"] = needed["ChromaticityWeight"] =
    With<TV>([](TV* f) { f->SetColorModelToChromaticityBrightness(); });
  needed["LinearLight"] = With<TV>(
    [](TV* f)
    {
      f->SetColorModelToOpponent();
      SetInputArray(f, 0, "bytes");
    });
  // With AutomaticThreshold, three steps are not enough to stop.
  needed["vtkMumfordShahFilter EdgeThreshold"] = needed["vtkMumfordShahFilter SmoothingLength"] =
    needed["vtkMumfordShahFilter StopTolerance"] =
      With<Shah>([](Shah* f) { f->AutomaticThresholdOff(); });
  needed["vtkIntrinsicTVFilter EdgeThreshold"] =
    With<TV>([](TV* f) { f->SetEdgeFunctionToCharbonnier(); });
  needed["vtkIntrinsicTVFilter StopTolerance"] = With<TV>([](TV* f) { f->SetModeToSteadyState(); });
  needed["vtkHarmonicMapFilter Beta"] = With<Harmonic>([](Harmonic* f) { f->SetExponent(1.2); });
  needed["ConsistentReaction"] = needed["ProjectToSphere"] =
    With<Harmonic>([](Harmonic* f) { f->SetSchemeToExplicitReaction(); });
  needed["UseAsNormals"] = needed["MoveVertices"] =
    With<Harmonic>([](Harmonic* f) { SetInputArray(f, 0, ""); }); // of the surface's normals
  needed["vtkHarmonicMapFilter GenerateTimeSteps"] = needed["vtkHarmonicMapFilter OutputInterval"] =
    With<Harmonic>([](Harmonic* f) { f->SetTimeStep(1.0); });
  needed["vtkTuringTextureFilter GenerateTimeSteps"] =
    needed["vtkTuringTextureFilter OutputInterval"] =
      needed["vtkTuringTextureFilter StopTolerance"] =
        With<Turing>([](Turing* f) { f->SetTimeStep(0.5); });
  needed["FeatureSize"] = With<Turing>([](Turing* f) { f->SetRefineTo(0.0); }); // far too fine
  needed["CoarseStartSize"] = With<Turing>([](Turing* f) { f->SetFeatureSize(8.0); });
  needed["AutomaticTimeStep"] = With<Turing>([](Turing* f) { f->SetTimeStep(0.01); });
  needed["ReactionRate"] = With<Turing>([](Turing* f) { f->SetUnitsToAbsolute(); });
  needed["ActivatorSupply"] = needed["SubstrateSupply"] =
    With<Turing>([](Turing* f) { f->SetKineticsToSchnakenberg(); });
  needed["FeedRate"] = needed["KillRate"] =
    With<Turing>([](Turing* f) { f->SetKineticsToGrayScott(); });
  needed["ReactantA"] = needed["ReactantB"] =
    With<Turing>([](Turing* f) { f->SetKineticsToBrusselator(); });
  needed["InhibitorDecayRate"] = needed["Saturation"] =
    With<Turing>([](Turing* f) { f->SetKineticsToGiererMeinhardt(); });
  needed["RecoveryRate"] = needed["RecoveryDamping"] = needed["Stimulus"] =
    With<Turing>([](Turing* f) { f->SetKineticsToFitzHughNagumo(); });
  needed["LowColor"] = needed["HighColor"] = With<Turing>([](Turing* f) { f->ColorOutputOn(); });
  needed["Mean"] = needed["AutomaticMeans"] = With<Segmentation>(
    [](Segmentation* f)
    {
      f->AutomaticMeansOff();
      for (int component = 0; component < 3; ++component)
      {
        f->SetMean(1, component, 1.3);
        f->SetMean(2, component, 2.1);
      }
    });
  needed["vtkSurfaceSegmentationFilter FidelityWeight"] =
    needed["vtkSurfaceSegmentationFilter Units"] =
      With<Segmentation>([](Segmentation* f) { f->AutomaticFidelityOff(); });
  needed["KeepRange"] = With<Spline>(
    [](Spline* f)
    {
      f->ExactOn();
      SetInputArray(f, 1, "mask");
    });
  needed["Smoothing"] = needed["vtkSurfaceInterpolationFilter Units"] =
    With<Spline>([](Spline* f) { f->AutomaticSmoothingOff(); });
  needed["NoiseScale"] = needed["IntegrationScale"] = needed["Contrast"] = needed["Alpha"] =
    With<Tensor>([](Tensor* f) { f->SetModelToCoherenceEnhancing(); });
  needed["vtkSurfaceDirectionFieldFilter SmoothingLength"] =
    With<Direction>([](Direction* f) { f->SetMethodToCurvatureAligned(); });
  needed["HintWeight"] = With<Direction>([](Direction* f) { f->SetMethodToHints(); });
  return needed;
}

/// A filter on a surface, with the settings that a property needs to have an effect.
vtkSmartPointer<vtkPolyDataAlgorithm> MakeFor(
  const FilterClass& kind, const RandomProperty& property, vtkPolyData* surface)
{
  static const auto needed = NeededSettings();
  const auto filter = kind.Make();
  filter->SetInputData(surface);
  const bool isTexture = kind.Name == "vtkTuringTextureFilter"; // it starts from noise
  const bool isRelief = kind.Name == "vtkSurfaceReliefFilter"; // of one component
  const bool isDistance = kind.Name == "vtkSurfaceDistanceFilter"; // from some points
  SetInputArray(filter, 0, isTexture ? "" : isRelief ? "height" : isDistance ? "few" : "f");
  SetInputArray(filter, 1, "mask");
  SetInputArray(filter, 2, "e1");
  if (auto* const tv = vtkIntrinsicTVFilter::SafeDownCast(filter)) // its search takes long
  {
    const bool isOfSearch =
      property.Name.find("Fidelity") != std::string::npos || property.Name == "NoiseLevel";
    tv->SetAutomaticFidelity(isOfSearch);
  }
  for (const std::string& name : { property.Name, kind.Name + " " + property.Name })
  {
    const auto found = needed.find(name);
    if (found != needed.end())
    {
      found->second(filter);
    }
  }
  if (const auto diffusion = vtkSurfaceDiffusionAlgorithm::SafeDownCast(filter))
  {
    diffusion->SetNumberOfTimeSteps(3);
  }
  return filter;
}

/// Changes one property many times. Returns whether two results without errors have differed.
bool ChangeAlone(const FilterClass& kind, const RandomProperty& property)
{
  const auto surface = PatchedEllipsoid();
  const auto filter = MakeFor(kind, property, surface);
  Messages messages(filter);
  auto last = vtkSmartPointer<vtkPolyDataAlgorithm>();
  bool hasEffect = false;
  Dice dice(1);
  for (int change = 0; change < 8; ++change)
  {
    const auto before = kind.Make();
    property.Copy(filter, before);
    for (int draw = 0; change > 0 && draw < 8 && property.Equal(filter, before); ++draw)
    {
      property.Set(filter, dice);
    }
    if (!messages.Errors.empty())
    {
      filter->Modified(); // the pipeline does not repeat an update that only gave errors
      messages.Errors.clear();
    }
    const auto twin = Twin(kind, filter);
    Messages ofTwin(twin);
    twin->SetInputData(surface);
    for (vtkPolyDataAlgorithm* either : { filter.Get(), twin.Get() })
    {
      UpdateAt(either, 1.2);
    }
    EXPECT_EQ(Sentences(messages), Sentences(ofTwin));
    EXPECT_EQ(Difference(filter, twin), "") << "change " << change;
    if (messages.Errors.empty())
    {
      hasEffect = hasEffect || (last && Difference(last, twin) != "");
      last = twin;
    }
  }
  return hasEffect;
}

/// A header without the lines of its comments.
std::string ReadCode(const std::filesystem::path& header)
{
  std::string code;
  std::ifstream file(header);
  for (std::string line; std::getline(file, line);)
  {
    const std::size_t first = line.find_first_not_of(' ');
    const bool isComment = first != std::string::npos && (line[first] == '*' || line[first] == '/');
    code += isComment ? std::string() : line + "\n";
  }
  return code;
}

/// The names X of all methods SetX() in the headers of a class and of its superclasses in this
/// library, without the methods SetXToY().
std::set<std::string> SettableInHeaders(const std::string& className)
{
  const std::filesystem::path folder = SURFACEDIFFUSION_FILTERS_DIR;
  std::set<std::string> names;
  std::string name = className;
  while (std::filesystem::exists(folder / (name + ".h")))
  {
    const std::string text = ReadCode(folder / (name + ".h"));
    const std::regex setter(
      R"((?:\bvtkSet\w*Macro\(\s*|\bSURFACEDIFFUSION_(?:PROPERTY|SWITCH|CHOICE|NAME)\(|\b(?:Set|Add))([A-Z]\w*)\b\s*[(,)])");
    for (std::sregex_iterator match(text.begin(), text.end(), setter), end; match != end; ++match)
    {
      names.insert((*match)[1]);
    }
    std::smatch base;
    const std::regex derived("class \\w+ " + name + "\\s*:\\s*public (\\w+)");
    name = std::regex_search(text, base, derived) ? std::string(base[1]) : std::string();
  }
  const std::set<std::string> all = names;
  for (const std::string& property : all)
  {
    for (auto it = names.begin(); it != names.end();)
    {
      const bool word = it->rfind(property + "To", 0) == 0;
      it = word ? names.erase(it) : std::next(it);
    }
  }
  return names;
}

class EveryProperty : public testing::TestWithParam<FilterClass>
{
};

std::string ClassName(const testing::TestParamInfo<FilterClass>& info)
{
  return info.param.Name.substr(3);
}

} // namespace

TEST_P(EveryProperty, ChangedAloneHasAnEffectAndGivesWhatANewFilterGives)
{
  const FilterClass& kind = this->GetParam();
  for (const RandomProperty& property : kind.Properties)
  {
    SCOPED_TRACE(kind.Name + " " + property.Name);
    const bool hasEffect = ChangeAlone(kind, property);
    const bool excused = WithoutEffect.count(property.Name) ||
      WithoutEffectInClass.count(kind.Name + " " + property.Name);
    EXPECT_TRUE(hasEffect || excused) << "no effect: does it need other settings?";
  }
}

/// Neither NaN nor -77 is allowed, but as a seed. Ranges are tested in Core.
TEST_P(EveryProperty, OfAForbiddenValueIsNamedInOneErrorAndTheInputPasses)
{
  const auto surface = PatchedEllipsoid();
  for (const RandomProperty& property : this->GetParam().Properties)
  {
    const auto filter = MakeFor(this->GetParam(), property, surface);
    const std::string value = property.SetForbidden(filter);
    if (value.empty() || property.Name == "RandomSeed")
    {
      continue;
    }
    Messages messages(filter);
    filter->Update();
    ASSERT_EQ(messages.Errors.size(), 1u) << property.Name;
    EXPECT_NE(
      messages.Errors[0].find(property.Name + " is " + value + "; allowed: "), std::string::npos)
      << property.Name << ": " << messages.Errors[0];
    EXPECT_TRUE(IsUnchanged(filter, surface)) << property.Name;
    for (int port = 1; port < filter->GetNumberOfOutputPorts(); ++port) // curves
    {
      EXPECT_EQ(filter->GetOutputDataObject(port)->GetNumberOfElements(vtkDataObject::POINT), 0);
    }
  }
}

TEST_P(EveryProperty, OfNoSurfaceIsOneError)
{
  const auto filter = this->GetParam().Make();
  Messages messages(filter);
  vtkNew<vtkPolyData> nothing, points;
  points->SetPoints(Sphere(1)->GetPoints());
  filter->SetInputData(nothing);
  filter->Update();
  filter->SetInputData(points);
  filter->Update();
  ASSERT_EQ(messages.Errors.size(), 2u);
  EXPECT_NE(messages.Errors[0].find("the input is empty"), std::string::npos);
  EXPECT_NE(messages.Errors[1].find("the input has no polygons"), std::string::npos);
}

/// A point that no triangle uses is usual, and so is noise of data and of points. Textures of an
/// eighth of the root of the area ask for a refinement of coarse surfaces.
TEST_P(EveryProperty, GivesNoWarningAtItsDefault)
{
  auto surface = Sphere(std::string(this->GetParam().Name) == "vtkTuringTextureFilter" ? 5 : 3);
  for (vtkIdType i = 0; i < surface->GetNumberOfPoints(); ++i)
  {
    double x[3];
    surface->GetPoint(i, x);
    vtkMath::MultiplyScalar(x, 1.0 + 0.02 * Rough(i, 1));
    surface->GetPoints()->SetPoint(i, x);
  }
  surface->GetPoints()->InsertNextPoint(0.0, 0.0, 3.0);
  AddPointArray(surface, "f", 1,
    [&](vtkIdType i, int) { return surface->GetPoint(i)[2] + 0.05 * Rough(i, 0); });
  const auto filter = this->GetParam().Make();
  if (filter->IsA("vtkSurfaceReliefFilter"))
  {
    AddPointArray(
      surface, "Texture", 1, [](vtkIdType i, int) { return 0.005 * (1.0 + Rough(i, 0)); });
  }
  surface->GetPointData()->SetActiveScalars("f");
  if (filter->IsA("vtkSurfaceDistanceFilter"))
  {
    AddPointArray(surface, "source", 1, [](vtkIdType i, int) { return i == 7; });
    SetInputArray(filter, 0, "source");
  }
  Messages messages(filter);
  filter->SetInputData(surface);
  filter->Update();
  EXPECT_EQ(messages.Warnings, std::vector<std::string>());
  EXPECT_EQ(messages.Errors, std::vector<std::string>());
}

INSTANTIATE_TEST_SUITE_P(
  AllFilters, EveryProperty, testing::ValuesIn(AllFilterClasses()), ClassName);

TEST(Properties, AreTheOnesOfTheHeaders)
{
  std::set<std::string> tested;
  for (const FilterClass& kind : AllFilterClasses())
  {
    std::set<std::string> known;
    for (const RandomProperty& property : kind.Properties)
    {
      EXPECT_TRUE(known.insert(property.Name).second) << property.Name << " twice";
    }
    std::vector<std::string> different;
    const std::set<std::string> settable = SettableInHeaders(kind.Name);
    std::set_symmetric_difference(
      known.begin(), known.end(), settable.begin(), settable.end(), std::back_inserter(different));
    EXPECT_EQ(different, std::vector<std::string>())
      << "of " << kind.Name
      << ", in the header or among the settings and in RandomProperties.cxx, but not in both";
    EXPECT_GT(settable.size(), 5u);
    tested.insert(kind.Name);
  }
  std::set<std::string> run;
  for (const FilterKind& kind : AllFilters())
  {
    run.insert(kind.Make()->GetClassName());
  }
  EXPECT_EQ(run, tested) << "kinds_of_run.txt and Properties.cxx have different classes";
  for (const auto& file : std::filesystem::directory_iterator(SURFACEDIFFUSION_FILTERS_DIR))
  {
    const std::string name = file.path().stem().string();
    const bool isClass = file.path().extension() == ".h" && name.rfind("vtk", 0) == 0;
    if (isClass && ReadCode(file.path()).find("static " + name + "* New()") != std::string::npos)
    {
      EXPECT_TRUE(tested.count(name)) << name << " is not in Properties.cxx";
    }
  }
}
