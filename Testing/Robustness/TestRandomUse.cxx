// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Filters used at random: arrays of any type and content, every property with values right and
// wrong, inputs and properties changed between updates, times requested in any order. After any
// such sequence a filter gives the bits that a new one with the same settings gives, or the same
// errors and the unchanged input. A property that is missing in what a filter compares to know
// whether its results are still valid shows here.
// SURFACEDIFFUSION_LONG=n in the environment makes it the n-th of many times as many uses.

#include "AllFilters.h"
#include "BadMeshes.h"
#include "RandomProperties.h"

#include "vtkCellArray.h"
#include "vtkFieldData.h"
#include "vtkVariant.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>

using namespace FilterTest;

namespace
{

vtkSmartPointer<vtkPolyData> RandomSurface(Dice& dice)
{
  static const auto bad = SurfaceDiffusion::Testing::BadMeshes();
  auto surface = vtkSmartPointer<vtkPolyData>::New();
  switch (dice.Below(3))
  {
    case 0:
      surface = Sphere(1 + dice.Below(2));
      break;
    case 1:
      surface = Grid(2 + dice.Below(6), 2 + dice.Below(6), 0.5 + dice.Unit());
      break;
    default:
    {
      const auto& shape = bad[dice.Below(static_cast<int>(bad.size()))].Shape;
      vtkNew<vtkPoints> points;
      points->SetDataType(dice.Flip() ? VTK_DOUBLE : VTK_FLOAT);
      for (const auto& v : shape.Vertices.rowwise())
      {
        points->InsertNextPoint(v.data());
      }
      vtkNew<vtkCellArray> cells;
      for (const auto& f : shape.Faces.rowwise())
      {
        cells->InsertNextCell({ f[0], f[1], f[2] });
      }
      surface->SetPoints(points);
      surface->SetPolys(cells);
    }
  }
  return surface;
}

/// Adds arrays of the names that SetRandomArray() chooses: of any type, sometimes with NaN or with
/// a wrong number of components.
void AddRandomArrays(Dice& dice, vtkPolyData* surface)
{
  const int types[] = { VTK_DOUBLE, VTK_FLOAT, VTK_UNSIGNED_CHAR, VTK_INT, VTK_SHORT };
  const auto add = [&](const char* name, int components, const auto& value)
  {
    if (!dice.Flip(8))
    {
      AddPointArray(
        surface, name, dice.Flip(16) ? components + 1 : components, value, types[dice.Below(5)]);
    }
  };
  const double size = dice.Flip(4) ? std::pow(10.0, dice.Below(300) - 150) : 100.0;
  const bool holes = dice.Flip(3);
  add("f", 1 + dice.Below(4),
    [&](vtkIdType i, int k)
    { return holes && dice.Flip(5) ? vtkMath::Nan() : std::abs(size * Rough(i, k)); });
  add("mask", 1, [&](vtkIdType, int) { return dice.Flip(6); });
  add("fixed", 1, [&](vtkIdType, int) { return dice.Flip(9); });
  add("e1", 3, [&](vtkIdType i, int k) { return dice.Flip(20) ? 0.0 : Rough(i, k); });
  add("rates", 4, [&](vtkIdType i, int k) { return 3.0 + Rough(i, k); });
  surface->GetPointData()->SetActiveScalars("f");
}

const char* const ArrayNames[] = { "f", "mask", "e1", "fixed", "rates" };

void SetRandomArray(Dice& dice, vtkPolyDataAlgorithm* filter)
{
  const int index = dice.Below(5);
  SetInputArray(filter, index, dice.Flip(3) ? "" : ArrayNames[index]);
}

/// A new filter with the same properties and arrays.
vtkSmartPointer<vtkPolyDataAlgorithm> Twin(const FilterClass& kind, vtkPolyDataAlgorithm* filter)
{
  const auto twin = kind.Make();
  for (const RandomProperty& property : kind.Properties)
  {
    property.Copy(filter, twin);
  }
  for (int index = 0; index < 5; ++index)
  {
    vtkNew<vtkInformation> copy;
    copy->Copy(filter->GetInputArrayInformation(index), 1);
    twin->SetInputArrayToProcess(index, copy);
  }
  return twin;
}

/// The same bits, or both not a number.
bool SameValues(vtkDataArray* a, vtkDataArray* b)
{
  bool same = a && b && a->GetDataType() == b->GetDataType() &&
    a->GetNumberOfComponents() == b->GetNumberOfComponents() &&
    a->GetNumberOfTuples() == b->GetNumberOfTuples();
  for (vtkIdType i = 0; same && i < a->GetNumberOfValues(); ++i)
  {
    const double x = a->GetVariantValue(i).ToDouble();
    const double y = b->GetVariantValue(i).ToDouble();
    same = x == y || (std::isnan(x) && std::isnan(y));
  }
  return same;
}

/// The names of the arrays that differ.
std::string DifferentArrays(vtkFieldData* a, vtkFieldData* b)
{
  std::string different = a->GetNumberOfArrays() == b->GetNumberOfArrays() ? "" : "their number ";
  for (int i = 0; i < a->GetNumberOfArrays(); ++i)
  {
    const char* const name = a->GetArrayName(i);
    different += SameValues(a->GetArray(i), b->GetArray(name)) ? "" : std::string(name) + " ";
  }
  return different;
}

/// What differs between the surfaces, their data and the histories.
std::string Difference(vtkPolyDataAlgorithm* a, vtkPolyDataAlgorithm* b)
{
  vtkPolyData* const x = a->GetOutput();
  vtkPolyData* const y = b->GetOutput();
  std::string different =
    SameValues(x->GetPoints()->GetData(), y->GetPoints()->GetData()) ? "" : "points ";
  different += DifferentArrays(x->GetPointData(), y->GetPointData());
  different += DifferentArrays(x->GetCellData(), y->GetCellData());
  if (a->GetNumberOfOutputPorts() > 1)
  {
    for (vtkPolyDataAlgorithm* const either : { a, b })
    {
      History(either)->GetRowData()->RemoveArray("Seconds");
    }
    different += DifferentArrays(History(a)->GetRowData(), History(b)->GetRowData());
  }
  return different;
}

bool IsFinite(vtkDataArray* array, vtkIdType point)
{
  bool finite = true;
  for (int k = 0; k < array->GetNumberOfComponents(); ++k)
  {
    finite = finite && std::isfinite(array->GetComponent(point, k));
  }
  return finite;
}

/// Whether what the filter has added is finite; points that no triangle uses keep even a NaN.
bool AddedIsFinite(vtkPolyData* output, vtkPolyData* input)
{
  vtkDataArray* given = input->GetPointData()->GetArray("f");
  bool finite = true;
  for (int a = 0; a < output->GetPointData()->GetNumberOfArrays(); ++a)
  {
    vtkDataArray* array = output->GetPointData()->GetArray(a);
    for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
    {
      const bool isNew = !input->GetPointData()->HasArray(array->GetName());
      finite = finite && (!isNew || (given && !IsFinite(given, i)) || IsFinite(array, i));
    }
  }
  return finite;
}

/// The errors without the object's address.
std::vector<std::string> Sentences(const Messages& messages)
{
  std::vector<std::string> sentences;
  for (const std::string& error : messages.Errors)
  {
    sentences.push_back(error.substr(error.find("): ") + 3));
  }
  return sentences;
}

/// Updates a filter of the class many times. `focus` is the property that is changed in any case,
/// alone, between two updates.
void UseAtRandom(const std::vector<FilterClass>& classes, unsigned int seed)
{
  Dice dice(seed);
  const FilterClass& kind = classes[seed % classes.size()];
  const RandomProperty& focus = kind.Properties[seed / classes.size() % kind.Properties.size()];
  const auto filter = kind.Make();
  const auto untouched = kind.Make();
  Messages messages(filter);
  vtkSmartPointer<vtkPolyData> surface = RandomSurface(dice);
  AddRandomArrays(dice, surface);
  for (int update = 0; update < 6; ++update)
  {
    if (update % 2 == 1 && messages.Errors.empty())
    {
      const auto before = kind.Make();
      focus.Copy(filter, before);
      for (int draw = 0; draw < 8 && focus.Equal(filter, before); ++draw)
      {
        focus.Set(filter, dice);
      }
    }
    else
    {
      for (int change = dice.Below(4); change > 0; --change)
      {
        kind.Properties[dice.Below(static_cast<int>(kind.Properties.size()))].Set(filter, dice);
      }
      if (dice.Flip())
      {
        SetRandomArray(dice, filter);
      }
      if (dice.Flip(4))
      {
        surface = RandomSurface(dice);
        AddRandomArrays(dice, surface);
      }
      else if (dice.Flip(4))
      {
        AddRandomArrays(dice, surface);
      }
    }
    if (!messages.Errors.empty())
    {
      filter->Modified(); // or the error is not reported again if nothing has changed
      messages.Errors.clear();
    }
    const auto twin = Twin(kind, filter);
    Messages ofTwin(twin);
    const double time = dice.Logarithmic(1e-2, 1e2);
    for (vtkPolyDataAlgorithm* either : { filter.Get(), twin.Get() })
    {
      either->SetInputData(surface);
      UpdateAt(either, time);
    }
    const std::string name = kind.Name + ", " + focus.Name + ", update " + std::to_string(update);
    ASSERT_EQ(Sentences(messages), Sentences(ofTwin)) << name;
    ASSERT_EQ(Difference(filter, twin), "") << name;
    ASSERT_TRUE(!messages.Errors.empty() || AddedIsFinite(filter->GetOutput(), surface)) << name;
    ASSERT_TRUE(messages.Errors.empty() || IsUnchanged(filter, surface)) << messages.Errors[0];
    // What is refused hides what is computed: most of it does not stay.
    for (const RandomProperty& property : kind.Properties)
    {
      if (!messages.Errors.empty() && dice.Flip())
      {
        property.Copy(untouched, filter);
      }
    }
  }
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

/// The names X of all SetX() that a class of the library and its superclasses in the library have,
/// without the forms SetXToY(): as their headers have them.
std::set<std::string> SettableInHeaders(const std::string& className)
{
  const std::filesystem::path folder = SURFACEDIFFUSION_FILTERS_DIR;
  std::set<std::string> names;
  std::string name = className;
  while (std::filesystem::exists(folder / (name + ".h")))
  {
    const std::string text = ReadCode(folder / (name + ".h"));
    const std::regex setter(R"((?:\bvtkSet\w*Macro\(\s*|\bSet)([A-Z]\w*)\b\s*[(,)])");
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

} // namespace

TEST(RandomUse, GivesWhatANewFilterGives)
{
  const auto classes = AllFilterClasses();
  const char* const part = std::getenv("SURFACEDIFFUSION_LONG");
  const unsigned int uses = part ? 30000 : 300;
  const unsigned int first = part ? uses * (std::strtoul(part, nullptr, 10) - 1) : 0;
  for (unsigned int seed = first; seed < first + uses && !HasFatalFailure(); ++seed)
  {
    SCOPED_TRACE("seed " + std::to_string(seed));
    UseAtRandom(classes, seed);
  }
}

TEST(RandomUse, SetsEveryPropertyThatTheHeadersHave)
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
      << "of " << kind.Name << ", in the header or in RandomProperties.h but not in both";
    EXPECT_GT(settable.size(), 5u);
    tested.insert(kind.Name);
  }
  for (const auto& file : std::filesystem::directory_iterator(SURFACEDIFFUSION_FILTERS_DIR))
  {
    const std::string name = file.path().stem().string();
    const bool isClass = file.path().extension() == ".h" && name.rfind("vtk", 0) == 0;
    if (isClass && ReadCode(file.path()).find("static " + name + "* New()") != std::string::npos)
    {
      EXPECT_TRUE(tested.count(name)) << name << " is not in RandomProperties.h";
    }
  }
}

TEST(RandomUse, DrawsOfEveryPropertyDifferentValues)
{
  for (const FilterClass& kind : AllFilterClasses())
  {
    for (const RandomProperty& property : kind.Properties)
    {
      Dice dice(1);
      const auto filter = kind.Make();
      const auto untouched = kind.Make();
      bool differs = false;
      for (int draw = 0; draw < 64 && !differs; ++draw)
      {
        property.Set(filter, dice);
        differs = !property.Equal(filter, untouched);
      }
      EXPECT_TRUE(differs) << kind.Name << " " << property.Name;
    }
  }
}
