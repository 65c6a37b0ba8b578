// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "FilterTest.h"

#include "vtkFVMHeatFilter.h"
#include "vtkSurfaceDistanceFilter.h"
#include "vtkSurfaceSegmentationFilter.h"

#include "vtkAppendPolyData.h"
#include "vtkElevationFilter.h"
#include "vtkExecutive.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationVector.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkObjectFactory.h"
#include "vtkPartitionedDataSet.h"
#include "vtkPlatonicSolidSource.h"
#include "vtkSphereSource.h"
#include "vtkTrivialProducer.h"

#include <gtest/gtest.h>

using namespace FilterTest;

namespace
{

/// Records the progress reports of a filter.
struct Reports
{
  explicit Reports(vtkAlgorithm* filter)
  {
    Listen(filter,
      [this](double amount)
      {
        this->Jump = std::max(this->Jump, amount - this->Last);
        this->Backwards = this->Backwards || amount < this->Last;
        this->Last = amount;
        ++this->Count;
      });
  }
  void Clear()
  {
    this->Count = 0;
    this->Last = this->Jump = 0.0;
    this->Backwards = false;
  }

  int Count = 0;
  double Last = 0.0;
  double Jump = 0.0;
  bool Backwards = false;
};

} // namespace

TEST(Updates, ReportProgressEvenly)
{
  auto sphere = Sphere(4);
  AddRough(sphere);
  for (const int solver : { vtkFVMHeatFilter::SOLVER_DIRECT,
         vtkFVMHeatFilter::SOLVER_CONJUGATE_GRADIENT, vtkFVMHeatFilter::SOLVER_MULTIGRID })
  {
    for (const int steps : { 0, 1, 2, 10, 200 })
    {
      for (const int mode : { 0, 1 })
      {
        auto filter = MakeHeatFilter(sphere);
        filter->SetSolver(solver);
        filter->SetNumberOfTimeSteps(steps);
        filter->SetMode(mode);
        filter->SetFidelityWeight(1.0);
        Reports reports(filter);
        filter->Update();
        EXPECT_GE(reports.Count, 10) << solver << ' ' << steps << ' ' << mode;
        EXPECT_LE(reports.Jump, 0.5) << solver << ' ' << steps << ' ' << mode;
        EXPECT_FALSE(reports.Backwards) << solver << ' ' << steps << ' ' << mode;
        EXPECT_EQ(reports.Last, 1.0);
      }
    }
  }
}

TEST(Updates, ReportProgressIfNearlyEverythingIsReused)
{
  auto sphere = Sphere(4);
  AddRough(sphere);
  auto filter = MakeHeatFilter(sphere);
  filter->GenerateTimeStepsOn();
  filter->Update();
  Reports reports(filter);
  for (const double time : { 5.0, 6.0, 0.0 })
  {
    reports.Clear();
    UpdateAt(filter, time);
    EXPECT_LE(reports.Jump, 0.5) << time;
    EXPECT_FALSE(reports.Backwards) << time;
    EXPECT_EQ(reports.Last, 1.0) << time;
  }
}

/// Taking the abort back is enough; scripts need not mark the filter as modified.
TEST(Updates, AnAbortedUpdateIsRepeatedByTheNextOne)
{
  auto sphere = Sphere(4);
  AddRough(sphere);
  auto reference = MakeHeatFilter(sphere);
  reference->Update();
  auto filter = MakeHeatFilter(sphere);
  const unsigned long tag = Listen(filter,
    [&](double amount)
    {
      if (amount > 0.3)
      {
        filter->AbortExecuteOn();
      }
    });
  filter->Update();
  EXPECT_EQ(Result(filter), nullptr);
  filter->RemoveObserver(tag);
  filter->AbortExecuteOff();
  filter->Update();
  EXPECT_TRUE(Identical(Result(filter), Result(reference)));
}

TEST(Updates, AnAbortedRunIsNotReused)
{
  auto sphere = Sphere(4);
  AddRough(sphere);
  auto reference = MakeHeatFilter(sphere);
  reference->Update();
  for (const double when : { 0.01, 0.2, 0.25, 0.3, 0.6, 0.9 })
  {
    auto filter = MakeHeatFilter(sphere);
    filter->Update();
    const double step = filter->GetTimeStep();
    const unsigned long tag = Listen(filter,
      [&](double amount)
      {
        if (amount >= when)
        {
          filter->AbortExecuteOn();
        }
      });
    filter->SetTimeStep(2.0 * step);
    filter->Update();
    filter->RemoveObserver(tag);
    filter->AbortExecuteOff();
    filter->SetTimeStep(step);
    filter->Update();
    EXPECT_TRUE(Identical(Result(filter), Result(reference))) << when;
  }
}

TEST(Updates, ChangesOfTheOutputAloneRecomputeNothing)
{
  auto sphere = Sphere(3);
  AddRough(sphere);
  auto filter = MakeHeatFilter(sphere);
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfStepsComputed(), 10);
  filter->SetResultArrayName("u");
  filter->Update();
  filter->SetOutputPrecisionToSingle();
  filter->Update();
  filter->Modified();
  filter->Update();
  filter->SetOutputInterval(3);
  filter->Update();
  EXPECT_EQ(Result(filter, "u")->GetDataType(), VTK_FLOAT);
  EXPECT_EQ(filter->GetNumberOfStepsComputed(), 10);
  AddPointArray(sphere, "unrelated", 1, Rough);
  sphere->Modified();
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfStepsComputed(), 10);
  EXPECT_NE(Result(filter, "unrelated"), nullptr);
}

TEST(Updates, DataThatDependOnTheMeshAloneAreReused)
{
  auto sphere = Sphere(4);
  AddRough(sphere);
  auto filter = MakeHeatFilter(sphere);
  filter->Update();
  double first = 2.0;
  Listen(filter, [&](double amount) { first = amount > 0.0 ? std::min(first, amount) : first; });
  filter->SetTimeStep(2.0);
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfStepsComputed(), 20);
  const double kept = first;
  sphere->GetPoints()->Modified(); // the contents are the same
  sphere->Modified();
  filter->Update();
  EXPECT_EQ(filter->GetNumberOfStepsComputed(), 20);
  first = 2.0;
  sphere->GetPoints()->SetPoint(7, 0.0, 0.0, 1.3);
  sphere->Modified();
  filter->Update();
  EXPECT_LT(first, kept); // building the surface reports first
}

TEST(Updates, OneOfSeveralPiecesIsAnErrorUnlessDeclaredWhole)
{
  vtkNew<vtkSphereSource> source;
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputConnection(source->GetOutputPort());
  SetInputArray(filter, 0, "Normals");
  Messages messages(filter);
  filter->UpdatePiece(0, 1, 0);
  EXPECT_TRUE(messages.Errors.empty());
  filter->UpdatePiece(0, 2, 0);
  EXPECT_EQ(messages.Errors.size(), 1u);
  EXPECT_EQ(Result(filter, "NormalsDiffused"), nullptr);
  filter->SetController(nullptr);
  filter->UpdatePiece(0, 2, 0);
  EXPECT_EQ(messages.Errors.size(), 1u);
  EXPECT_NE(Result(filter, "NormalsDiffused"), nullptr);
}

namespace
{

/// A surface that is in the first piece, however many it is asked for.
class OnePiece : public vtkPolyDataAlgorithm
{
public:
  static OnePiece* New();
  vtkTypeMacro(OnePiece, vtkPolyDataAlgorithm);
  vtkSmartPointer<vtkPolyData> Surface;

protected:
  OnePiece() { this->SetNumberOfInputPorts(0); }
  int RequestInformation(
    vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) override
  {
    outputs->GetInformationObject(0)->Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1);
    return 1;
  }
  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* outputs) override
  {
    vtkPolyData::GetData(outputs)->ShallowCopy(this->Surface);
    return 1;
  }
};
vtkStandardNewMacro(OnePiece);

} // namespace

TEST(Updates, APieceThatWasRefusedIsTakenAsAWholeSurface)
{
  vtkNew<OnePiece> source;
  source->Surface = Sphere(2);
  AddRough(source->Surface);
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputConnection(source->GetOutputPort());
  Messages messages(filter);
  filter->UpdatePiece(0, 2, 0);
  filter->UpdatePiece(0, 2, 0);
  EXPECT_EQ(messages.Errors.size(), 1u);
  filter->UpdatePiece(0, 1, 0);
  EXPECT_EQ(messages.Errors.size(), 1u);
  EXPECT_NE(Result(filter), nullptr);
}

TEST(Updates, PiecesThatDoNotAgreeAreTakenAsSurfacesOfTheirOwn)
{
  const auto first = Sphere(2), second = Sphere(2);
  AddRough(first);
  AddRough(second, 3);
  vtkNew<vtkPartitionedDataSet> pieces;
  pieces->SetPartition(0, first);
  pieces->SetPartition(1, second);
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, first);
  blocks->SetBlock(1, second);
  vtkNew<vtkTrivialProducer> producer;
  producer->SetOutput(pieces);
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputConnection(producer->GetOutputPort());
  Messages messages(filter);
  EXPECT_EQ(filter->GetExecutive()->Update(), 0);
  producer->SetOutput(blocks);
  EXPECT_EQ(filter->GetExecutive()->Update(), 1);
  EXPECT_EQ(messages.Errors.size(), 1u);
}

TEST(Updates, OneOfSeveralPiecesIsAnErrorBehindOtherFiltersToo)
{
  vtkNew<vtkSphereSource> source;
  vtkNew<vtkElevationFilter> elevation;
  elevation->SetInputConnection(source->GetOutputPort());
  vtkNew<vtkAppendPolyData> together;
  together->AddInputData(Sphere(1));
  together->AddInputConnection(elevation->GetOutputPort());
  vtkNew<vtkFVMHeatFilter> filter;
  SetInputArray(filter, 0, "Elevation");
  Messages messages(filter);
  std::size_t errors = 0;
  for (vtkAlgorithmOutput* const last : { elevation->GetOutputPort(), together->GetOutputPort() })
  {
    filter->SetInputConnection(last);
    filter->UpdatePiece(1, 2, 0);
    ASSERT_EQ(messages.Errors.size(), ++errors);
    EXPECT_NE(messages.Errors.back().find("one of 2 pieces"), std::string::npos);
    EXPECT_EQ(Result(filter, "ElevationDiffused"), nullptr);
  }
}

TEST(Updates, TheWholeOutputOfASourceWithoutPiecesIsNoPiece)
{
  vtkNew<vtkPlatonicSolidSource> source;
  vtkNew<vtkElevationFilter> elevation;
  elevation->SetInputConnection(source->GetOutputPort());
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputConnection(elevation->GetOutputPort());
  SetInputArray(filter, 0, "Elevation");
  Messages messages(filter);
  filter->UpdatePiece(0, 2, 0);
  EXPECT_TRUE(messages.Errors.empty());
  EXPECT_NE(Result(filter, "ElevationDiffused"), nullptr);
}

TEST(Updates, WithoutResultHaveTheReadOnlyValuesBeforeTheFirstOne)
{
  const auto surface = Sphere(3);
  AddPointArray(surface, "f", 1, Rough);
  surface->GetPointData()->SetActiveScalars("f");
  vtkNew<vtkFVMHeatFilter> heat;
  vtkNew<vtkSurfaceSegmentationFilter> segmentation;
  vtkNew<vtkSurfaceDistanceFilter> distance;
  const auto values = [&]
  {
    return std::vector<double>{ heat->GetMeanEdgeLength(), heat->GetTimeUnit(),
      heat->GetValueRange(), double(heat->GetNumberOfStepsComputed()), segmentation->GetGap(),
      segmentation->GetMeanEdgeLength(), distance->GetMeanEdgeLength(),
      double(distance->GetNumberOfSources()) };
  };
  const std::vector<vtkPolyDataAlgorithm*> filters = { heat, segmentation, distance };
  const std::vector<double> initial = values();
  const auto updateAll = [&]
  {
    for (vtkPolyDataAlgorithm* const filter : filters)
    {
      const Messages quiet(filter);
      filter->Modified();
      filter->Update();
    }
  };
  const auto expectValues = [&]
  {
    updateAll();
    const std::vector<double> found = values();
    for (std::size_t i = 0; i < found.size(); ++i)
    {
      EXPECT_NE(found[i], initial[i]) << i;
    }
    EXPECT_FALSE(std::isnan(segmentation->GetEffectiveMean(1, 0)));
  };
  const auto expectInitial = [&]
  {
    updateAll();
    EXPECT_EQ(values(), initial);
    EXPECT_TRUE(std::isnan(segmentation->GetEffectiveMean(1, 0)));
  };
  for (vtkPolyDataAlgorithm* const filter : filters)
  {
    filter->SetInputData(surface);
  }
  expectValues();
  for (vtkPolyDataAlgorithm* const filter : filters)
  {
    SetInputArray(filter, 0, "none");
  }
  expectInitial();
  for (vtkPolyDataAlgorithm* const filter : filters)
  {
    SetInputArray(filter, 0, "f");
  }
  expectValues();
  for (vtkPolyDataAlgorithm* const filter : filters)
  {
    Listen(filter, [filter](double) { filter->SetAbortExecute(1); });
  }
  AddPointArray(surface, "f", 1, [](vtkIdType i, int k) { return Rough(i + 1, k); });
  expectInitial();
}
