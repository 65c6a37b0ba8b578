// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// Files of the page: what is written is read, and damaged files end in a sentence. Each format is
// damaged in the same random ways every time.

#include "Files/SurfaceFile.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

namespace SurfaceDiffusion::Files
{

namespace
{

SurfaceFile MakeSurface()
{
  SurfaceFile surface;
  surface.Points = { 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.25, 0.125, 1.5 };
  for (const std::vector<std::int64_t>& corners :
    { std::vector<std::int64_t>{ 0, 2, 1 }, { 0, 1, 3 }, { 1, 2, 3 }, { 2, 0, 3 } })
  {
    surface.AddCell(corners);
  }
  surface.Arrays.push_back({ "height", false, 1, { 0.1, 0.2, 0.3, 0.4 } });
  surface.Arrays.push_back({ "colour", false, 3, { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 255 }, true });
  surface.Arrays.push_back({ "cell <\"number\">", true, 1, { 1.0, 2.0, 3.0, 4.0 } });
  return surface;
}

SurfaceFile Read(const std::string& name, const Bytes& bytes)
{
  return ReadFile(name, bytes.data(), bytes.size());
}

bool HasNumbers(const SurfaceFile& file, const FileArray& expected)
{
  return std::any_of(file.Arrays.begin(), file.Arrays.end(),
    [&](const FileArray& array)
    {
      return array.Numbers == expected.Numbers && array.OnCells == expected.OnCells &&
        array.Components == expected.Components;
    });
}

class Format : public testing::TestWithParam<const char*>
{
};

} // namespace

TEST_P(Format, IsReadAsItWasWritten)
{
  const SurfaceFile surface = MakeSurface();
  const std::string name = GetParam();
  const SurfaceFile found = Read(name, WriteFile(name, surface));
  EXPECT_EQ(found.NumberOfPoints(), surface.NumberOfPoints());
  EXPECT_EQ(found.NumberOfCells(), surface.NumberOfCells());
  if (name != "a.stl")
  {
    EXPECT_EQ(found.Points, surface.Points);
    EXPECT_EQ(found.Corners, surface.Corners);
  }
  for (const FileArray& array : surface.Arrays)
  {
    const bool isVtk = name == "a.vtp" || name == "a.vtu" || name == "a.vtk";
    EXPECT_TRUE(HasNumbers(found, array) || !(isVtk || (name == "a.ply" && !array.OnCells)))
      << array.Name;
  }
}

TEST_P(Format, IsReadOrEndsInASentenceWhereItIsDamaged)
{
  const std::string name = GetParam();
  const Bytes whole = WriteFile(name, MakeSurface());
  std::mt19937 random(1);
  const auto below = [&](std::size_t end) { return static_cast<std::size_t>(random()) % end; };
  for (int k = 0; k < 2000; ++k)
  {
    Bytes bytes = whole;
    if (k % 4 == 0)
    {
      bytes.resize(1 + below(bytes.size()));
    }
    for (std::size_t changes = k % 4 == 0 ? 0 : 1 + below(4); changes > 0; --changes)
    {
      const std::uint8_t signs[] = { '9', '-', 0, 255, '<', '"', ' ', '\n' };
      const std::size_t place = below(bytes.size());
      bytes[place] =
        k % 2 == 0 ? static_cast<std::uint8_t>(random()) : signs[below(std::size(signs))];
    }
    try
    {
      const SurfaceFile file = Read(name, bytes);
      EXPECT_TRUE(file.NumberOfCells() > 0 || !file.Arrays.empty());
    }
    catch (const FileError& error)
    {
      const std::string text = error.what();
      EXPECT_EQ(text.find('\n'), std::string::npos) << text;
      EXPECT_LT(text.size(), 250u) << text;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Files, Format,
  testing::Values(
    "a.stl", "a.ply", "a.obj", "a.off", "a.vtp", "a.vtu", "a.vtk", "a.gii", "a.3mf", "lh.a"),
  [](const testing::TestParamInfo<const char*>& tested)
  {
    std::string name = tested.param;
    std::replace(name.begin(), name.end(), '.', '_');
    return name;
  });

TEST(Files, ValuesOfTablesHaveTheNamesOfTheirColumns)
{
  const std::string text = "x;y;z;height\n0;0;0;1.5\n1;0;0;\n";
  const SurfaceFile file = Read("a.csv", Bytes(text.begin(), text.end()));
  EXPECT_EQ(file.NumberOfPoints(), 2u);
  ASSERT_EQ(file.Arrays.size(), 1u);
  EXPECT_EQ(file.Arrays[0].Name, "height");
  EXPECT_EQ(file.Arrays[0].Numbers[0], 1.5);
  EXPECT_TRUE(file.Arrays[0].Numbers[1] != file.Arrays[0].Numbers[1]);
}

} // namespace SurfaceDiffusion::Files
