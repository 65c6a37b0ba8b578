// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// VTK's conventions for classes: each property is printed, objects are made by object factories, and
// nothing that an update has made outlives the filter.

#include "AllFilters.h"
#include "RandomProperties.h"

#include "vtkObjectFactory.h"
#include "vtkVersionMacros.h"
#include "vtkWeakPointer.h"

#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

using namespace FilterTest;

namespace
{

/// What a factory makes in place of one of the filters.
class OtherFilter : public vtkFVMHeatFilter
{
public:
  static OtherFilter* New();
  vtkTypeMacro(OtherFilter, vtkFVMHeatFilter);
};
vtkStandardNewMacro(OtherFilter);

class Factory : public vtkObjectFactory
{
public:
  static Factory* New();
  vtkTypeMacro(Factory, vtkObjectFactory);
  const char* GetVTKSourceVersion() override { return VTK_SOURCE_VERSION; }
  const char* GetDescription() override { return "a factory for this test"; }

protected:
  Factory()
  {
    this->RegisterOverride("vtkFVMHeatFilter", "OtherFilter", "for this test", 1,
      []() -> vtkObject* { return OtherFilter::New(); });
  }
};
vtkStandardNewMacro(Factory);

} // namespace

TEST(Conventions, EachPropertyIsPrintedOnce)
{
  for (const FilterClass& kind : AllFilterClasses())
  {
    std::ostringstream text;
    kind.Make()->Print(text);
    for (const RandomProperty& property : kind.Properties)
    {
      if (property.Name != "Mean") // printed for each region that has one
      {
        const std::string all = text.str();
        const std::regex line("\n  " + property.Name + ": ");
        EXPECT_EQ(std::distance(std::sregex_iterator(all.begin(), all.end(), line), {}), 1)
          << property.Name << " of " << kind.Name;
      }
    }
  }
}

TEST(Conventions, NewInstancesAreOfTheSameClass)
{
  for (const FilterClass& kind : AllFilterClasses())
  {
    const auto filter = kind.Make();
    const auto other = vtkSmartPointer<vtkPolyDataAlgorithm>::Take(filter->NewInstance());
    EXPECT_EQ(other->GetClassName(), kind.Name);
    EXPECT_NE(other, filter);
    EXPECT_TRUE(other->IsA("vtkSurfaceFilter"));
    EXPECT_EQ(other->GetReferenceCount(), 1);
  }
}

TEST(Conventions, FactoriesOverrideClasses)
{
  vtkNew<Factory> factory;
  vtkObjectFactory::RegisterFactory(factory);
  vtkNew<vtkFVMHeatFilter> other;
  vtkObjectFactory::UnRegisterFactory(factory);
  vtkNew<vtkFVMHeatFilter> own;
  EXPECT_STREQ(other->GetClassName(), "OtherFilter");
  EXPECT_STREQ(own->GetClassName(), "vtkFVMHeatFilter");
}

TEST(Conventions, NothingOutlivesAFilter)
{
  for (const FilterKind& kind : AllFilters())
  {
    auto surface = Sphere(1);
    AddRough(surface);
    AddArraysOfAllFilters(surface);
    std::vector<vtkWeakPointer<vtkObjectBase>> made;
    {
      const auto filter = kind.Make();
      filter->SetInputData(surface);
      filter->Update();
      made.emplace_back(filter);
      made.emplace_back(filter->GetExecutive());
      for (int port = 0; port < filter->GetNumberOfOutputPorts(); ++port)
      {
        made.emplace_back(filter->GetOutputDataObject(port));
      }
      made.emplace_back(filter->GetOutput()->GetPointData()->GetArray(kind.Result.c_str()));
      made.emplace_back(filter->GetOutput()->GetCellData()->GetArray(kind.Result.c_str()));
    }
    for (const auto& object : made)
    {
      EXPECT_EQ(object.GetPointer(), nullptr) << kind.Name;
    }
    EXPECT_EQ(surface->GetReferenceCount(), 1) << kind.Name;
    EXPECT_EQ(surface->GetPoints()->GetReferenceCount(), 1) << kind.Name;
  }
}
