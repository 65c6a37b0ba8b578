// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// An update that reports an error fails, for programs to see: in the executive's answer, once, and in
// GetErrorCode() until something changes. An abort is no failure.

#include "AllFilters.h"

#include "vtkCallbackCommand.h"
#include "vtkCompositeDataIterator.h"
#include "vtkErrorCode.h"
#include "vtkExecutive.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkStringOutputWindow.h"

using namespace FilterTest;

namespace
{

class Failures : public testing::TestWithParam<FilterKind>
{
protected:
  Failures()
  {
    AddRough(this->Surface);
    AddArraysOfAllFilters(this->Surface);
    this->Filter->SetInputData(this->Surface);
  }

  int Update() { return this->Filter->GetExecutive()->Update(); }
  void SetNumberOfThreads(int number) // a negative one is an error
  {
    vtkSurfaceFilter::SafeDownCast(this->Filter)->SetNumberOfThreads(number);
  }

  vtkSmartPointer<vtkPolyData> Surface = Sphere(this->GetParam().Levels(4));
  vtkSmartPointer<vtkPolyDataAlgorithm> Filter = this->GetParam().Make();
};

/// Everything that is displayed during its lifetime.
class Display
{
public:
  Display() { vtkOutputWindow::SetInstance(this->Window); }
  ~Display() { vtkOutputWindow::SetInstance(this->Before); }
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  std::string Text() const { return this->Window->GetOutput(); }

private:
  const vtkSmartPointer<vtkOutputWindow> Before = vtkOutputWindow::GetInstance();
  vtkNew<vtkStringOutputWindow> Window;
};

/// Counts the executions of a filter.
struct Executions
{
  explicit Executions(vtkAlgorithm* filter)
  {
    vtkNew<vtkCallbackCommand> start;
    start->SetClientData(this);
    start->SetCallback([](vtkObject*, unsigned long, void* self, void*)
      { ++static_cast<Executions*>(self)->Number; });
    filter->AddObserver(vtkCommand::StartEvent, start);
  }
  int Number = 0;
};

} // namespace

TEST_P(Failures, AreReportedAndExecutedOnceUntilSomethingChanges)
{
  Messages messages(this->Filter);
  Executions executions(this->Filter);
  const auto expectFailures = [&](std::size_t failures)
  {
    EXPECT_EQ(this->Update(), 0);
    for (int update = 0; update < 3; ++update)
    {
      this->Update();
      EXPECT_EQ(this->Filter->GetErrorCode(), vtkErrorCode::UserError);
      EXPECT_TRUE(IsUnchanged(this->Filter, this->Surface));
    }
    EXPECT_EQ(messages.Errors.size(), failures);
    EXPECT_EQ(executions.Number, static_cast<int>(failures));
  };
  this->SetNumberOfThreads(-1);
  expectFailures(1);
  this->SetNumberOfThreads(-2);
  expectFailures(2);
  this->Surface->GetPoints()->SetPoint(3, 0.1, 0.2, 0.3);
  this->Surface->GetPoints()->Modified();
  expectFailures(3);
  this->SetNumberOfThreads(0);
  EXPECT_EQ(this->Update(), 1);
  EXPECT_EQ(this->Filter->GetErrorCode(), vtkErrorCode::NoError);
  EXPECT_NE(ResultOf(this->Filter, this->GetParam().Result), nullptr);
  EXPECT_EQ(this->Update(), 1);
  EXPECT_EQ(executions.Number, 4) << "an update that has succeeded is repeated";
  EXPECT_EQ(messages.Errors.size(), 3u);
}

TEST_P(Failures, AreReportedOnceForAllTimesAndPieces)
{
  Messages messages(this->Filter);
  this->SetNumberOfThreads(-1);
  if (auto* const steps = vtkSurfaceDiffusionAlgorithm::SafeDownCast(this->Filter))
  {
    steps->GenerateTimeStepsOn();
  }
  this->Filter->UpdatePiece(0, 1, 0);
  this->Filter->UpdatePiece(0, 1, 1);
  for (const double time : { 0.0, 1.0, 0.5 })
  {
    this->Filter->UpdateTimeStep(time);
    EXPECT_TRUE(IsUnchanged(this->Filter, this->Surface)) << time;
    EXPECT_EQ(this->Filter->GetErrorCode(), vtkErrorCode::UserError);
  }
  EXPECT_EQ(messages.Errors.size(), 1u);
}

TEST_P(Failures, AfterASuccessLeaveNoResultOfIt)
{
  EXPECT_EQ(this->Update(), 1);
  Messages messages(this->Filter);
  this->SetNumberOfThreads(-1);
  EXPECT_EQ(this->Update(), 0);
  EXPECT_TRUE(IsUnchanged(this->Filter, this->Surface));
  for (int port = 1; port < this->Filter->GetNumberOfOutputPorts(); ++port)
  {
    vtkDataObject* const further = this->Filter->GetOutputDataObject(port);
    EXPECT_EQ(further->GetNumberOfElements(vtkDataObject::POINT) +
        further->GetNumberOfElements(vtkDataObject::CELL) +
        further->GetNumberOfElements(vtkDataObject::ROW),
      0);
  }
}

TEST_P(Failures, OfABlockAreThoseOfAll)
{
  vtkNew<vtkMultiBlockDataSet> blocks;
  blocks->SetBlock(0, this->Surface);
  vtkNew<vtkPolyData> other;
  other->DeepCopy(this->Surface);
  blocks->SetBlock(1, other);
  this->Filter->SetInputDataObject(blocks);
  Messages messages(this->Filter);
  other->GetPoints()->SetPoint(3, vtkMath::Nan(), 0.0, 0.0);
  EXPECT_EQ(this->Update(), 0);
  EXPECT_NE(this->Filter->GetErrorCode(), vtkErrorCode::NoError);
  auto* const output = vtkMultiBlockDataSet::SafeDownCast(this->Filter->GetOutputDataObject(0));
  ASSERT_NE(output, nullptr);
  for (unsigned int b = 0; b < 2; ++b)
  {
    auto* const block = vtkPolyData::SafeDownCast(output->GetBlock(b));
    ASSERT_NE(block, nullptr);
    EXPECT_EQ(block->GetPointData()->GetNumberOfArrays(),
      this->Surface->GetPointData()->GetNumberOfArrays());
    EXPECT_EQ(
      block->GetCellData()->GetNumberOfArrays(), this->Surface->GetCellData()->GetNumberOfArrays());
  }
  other->GetPoints()->SetPoint(3, 0.1, 0.2, 0.3);
  other->GetPoints()->Modified();
  other->Modified();
  EXPECT_EQ(this->Update(), 1);
  EXPECT_EQ(this->Filter->GetErrorCode(), vtkErrorCode::NoError);
}

TEST_P(Failures, AreNoAborts)
{
  Messages messages(this->Filter);
  const unsigned long tag = Listen(this->Filter,
    [&](double amount)
    {
      if (amount > 0.0 && amount < 1.0)
      {
        this->Filter->AbortExecuteOn();
      }
    });
  EXPECT_EQ(this->Update(), 1);
  EXPECT_EQ(this->Filter->GetErrorCode(), vtkErrorCode::NoError);
  EXPECT_TRUE(messages.Errors.empty());
  this->Filter->RemoveObserver(tag);
}

INSTANTIATE_TEST_SUITE_P(Updates, Failures, testing::ValuesIn(AllFilters()), KindName);

TEST(Failures, AreDisplayedOnceWithoutARequest)
{
  const auto surface = Sphere(2);
  AddRough(surface);
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputData(surface);
  SetInputArray(filter, 0, "absent");
  const Display display;
  EXPECT_EQ(filter->GetExecutive()->Update(), 0);
  const std::string text = display.Text();
  EXPECT_NE(text.find("InputArray \"absent\""), std::string::npos) << text;
  EXPECT_EQ(text.find("ERROR"), text.rfind("ERROR")) << text;
  EXPECT_EQ(text.find("vtkInformation"), std::string::npos) << text;
}

TEST(Failures, OtherErrorsOfTheExecutiveAreDisplayed)
{
  vtkNew<vtkFVMHeatFilter> filter;
  const auto surface = Sphere(2);
  filter->SetInputData(surface); // without data
  filter->Update();
  filter->RemoveAllInputs();
  const Display display;
  filter->Update();
  EXPECT_NE(display.Text().find("ERROR"), std::string::npos) << display.Text();
}

TEST(Failures, StopTheFiltersBehindWhichThenGetTheInput)
{
  const auto surface = Sphere(2);
  AddRough(surface);
  vtkNew<vtkFVMHeatFilter> filter;
  filter->SetInputData(surface);
  vtkNew<vtkFVMHeatFilter> behind;
  behind->SetInputConnection(filter->GetOutputPort());
  Messages messages(filter);
  SetInputArray(filter, 0, "absent");
  EXPECT_EQ(behind->GetExecutive()->Update(), 0);
  EXPECT_EQ(behind->GetOutput()->GetNumberOfPoints(), 0);
  EXPECT_EQ(behind->GetExecutive()->Update(), 1);
  EXPECT_EQ(behind->GetOutput()->GetNumberOfPoints(), surface->GetNumberOfPoints());
  EXPECT_EQ(messages.Errors.size(), 1u);
  SetInputArray(filter, 0, "f");
  EXPECT_EQ(behind->GetExecutive()->Update(), 1);
  EXPECT_TRUE(behind->GetOutput()->GetPointData()->HasArray("fDiffused"));
  EXPECT_TRUE(behind->GetOutput()->GetPointData()->HasArray("fDiffusedDiffused"));
}

namespace
{

/// Whether the output has a finite result, or else an error names the property.
template <typename Filter>
void ExpectFiniteOrNamed(
  const char* property, const char* result, const std::function<void(Filter*)>& set)
{
  const auto surface = Sphere(3);
  AddRough(surface, 3);
  vtkNew<Filter> filter;
  filter->SetInputData(surface);
  filter->SetNumberOfTimeSteps(3);
  set(filter);
  Messages messages(filter);
  filter->Update();
  vtkDataArray* const values = ResultOf(filter, result);
  if (values)
  {
    EXPECT_TRUE(AllFinite(values)) << property;
    return;
  }
  ASSERT_EQ(messages.Errors.size(), 1u) << property;
  const std::string name = std::string(property) + " is ";
  EXPECT_NE(messages.Errors[0].find(name), std::string::npos) << messages.Errors[0];
}

} // namespace

TEST(Failures, OfExtremePropertiesNameThem)
{
  using TV = vtkIntrinsicTVFilter;
  using Shah = vtkMumfordShahFilter;
  for (const double extreme : { 1e300, 1e200, 1e-200, 1e-300, 1e-323 })
  {
    ExpectFiniteOrNamed<vtkFVMHeatFilter>(
      "FWHM", "fDiffused", [=](vtkFVMHeatFilter* f) { f->SetFWHM(extreme); });
    ExpectFiniteOrNamed<TV>("EdgeThreshold", "fTV",
      [=](TV* f)
      {
        f->SetEdgeFunctionToPeronaMalikRational();
        f->SetEdgeThreshold(extreme);
      });
    ExpectFiniteOrNamed<vtkTensorDiffusionFilter>(
      "ColorScale", "fBeltrami", [=](vtkTensorDiffusionFilter* f) { f->SetColorScale(extreme); });
    ExpectFiniteOrNamed<Shah>(
      "SmoothingLength", "fMumfordShah", [=](Shah* f) { f->SetSmoothingLength(extreme); });
    ExpectFiniteOrNamed<Shah>(
      "EdgeThreshold", "fMumfordShah", [=](Shah* f) { f->SetEdgeThreshold(extreme); });
    ExpectFiniteOrNamed<Shah>(
      "EdgeWidth", "fMumfordShah", [=](Shah* f) { f->SetEdgeWidth(extreme); });
  }
}
