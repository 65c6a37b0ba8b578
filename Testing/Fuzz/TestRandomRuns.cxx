// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "RandomRun.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

using namespace SurfaceDiffusion::Testing;

TEST(RandomRuns, KeepWhatTheCorePromises)
{
  std::mt19937 random(2026); // the same numbers on every platform
  std::array<int, NumberOfModels> runs{}, results{};
  for (int run = 0; run < 1500; ++run)
  {
    std::vector<std::uint8_t> bytes(40 + random() % 360);
    for (std::uint8_t& byte : bytes)
    {
      byte = static_cast<std::uint8_t>(random() >> 11);
    }
    EXPECT_NO_THROW({
      const Outcome outcome = RunFromBytes(bytes.data(), bytes.size());
      ++runs[outcome.Model];
      results[outcome.Model] += outcome.HasResult;
    }) << "run "
       << run;
  }
  // A model that fails in most runs would keep its promises in vain.
  for (int model = 0; model < NumberOfModels; ++model)
  {
    std::printf("model %d: %d results of %d runs\n", model, results[model], runs[model]);
    EXPECT_GE(4 * results[model], 3 * runs[model]) << "model " << model;
    EXPECT_GT(runs[model], 100) << "model " << model;
  }
}

/// Inputs on which the guided fuzzer found defects, in hexadecimal digits.
TEST(RandomRuns, StayAsTheyWereMended)
{
  const std::vector<std::string> found = {
    // a triangle so flat that minimising total variation took steps without bounds
    "2c00ffffffff1100000111ff0900ff0000090001000011ff0a009e9e9e9e9e9e9e9e043f0090ff010000f8ff"
    "ffff3f00000000049b25",
    // the same in a linear step by conjugate gradients
    "00120000f9010012002dff2900ff7a5555555555552dff036c2d5bd5031000ff3e57ddffff3d00ff2d00ff2d"
    "00ffff1affff2f00ff1affff2f00fffffcff",
    // a triangle so flat that the minimiser had more energy than the start
    "2c00ffffffff110000010009ffff11000009000100006b11ff0a00043f0000010007ff000000000000ff5df2"
    "d8d8d8d8d8d8d8e6b20061ffffff5b0425",
    // an edge from a vertex to itself whose weight exceeds all others but cancels
    "090140000101400001f85b0a40f25de10001ffd4f8f2f83f6d6d6d6d6d7a40300a5de60001ff00000000ff17"
    "f200ffff40ffffffffffffffffffffffd500d4f8303ff230010000fe0000000000000007280afffffff25d"
    "c10400f20130ef030111ffa2fbff0dfff2",
    // the same for a line field, in which such an edge may have opposite signs at its ends
    "090140000101403f000060575757a9a65757820000310a0100ff7fffff26dfffffff002c00000015a24e3161636544"
    "69a2a2a200090201000060575757a9a65757820000310a0100ff7fffff26dfffffffff05ffaa080cff820000310a01"
    "00ff7fffff26dfffffffff05ffaa09e104f23001000109ffa2fbff0dfff204045d04aa0e04",
    // probabilities that lost digits in the projection of large values onto the simplex
    "2c0000000009129a7600f0f20000102b2b2b2b2b008001005180010051022b2b3d3d3d3d3d3dd9d9d9d9d9d9"
    "0000000000000003d8d9010054805501005102eccd000000cd4d21ff",
    // a large fidelity weight, which multiplies the round-off of the energy
    "006e7fffff00022afffffb0000215801fb329a76fffb0d0002fd0009028d2da176a8005801fb129a76fff9f9"
    "f9f90700000000000000f9f9f9fff9f9f9f9f9f9f9f9f9f9f9f9f90201f9f900",
    // a flat triangle with steep data, on which the tensor of the Beltrami flow lost its positivity
    "40497fff9999129912fbff769aa800f84cff9a76fffbffffff028d2dfffffffffffff7ffffffffffffffffff"
    "ffff9a76a8005801fb769a9999999999999999999999029999999999999999129afbacff76a8ffffffffffff"
    "ffffffffffffffffffffffff00f84cffff5102ecd3",
    // gradients of 1e89, whose area the energy of the Beltrami flow does not count in full
    "08008000ff00fd0000001111040100010000110100000000002e0101001101ffffffffffffff05ffff6a7300"
    "b7002b1a0100010000002e0101001101ffffffffffffff0a04ffed2ea30004a340",
    // triangles drawn so flat that a blur does not keep constants
    "8000bcffff0100105b0100ff3bff8011ff002b2b2b2b2b2bf6fe0f012bededededededededededededededed"
    "ededed010000c8ededededff01e5ffffffbf00260400f4ffffff09b6ffff11ec5d",
    // the round-off of a constant, in which total variation is linear
    "8000ff47291153004e6040006c6f63616c6535012c0001ff60ff010d00f7ff00f7f47fffff2c2c2c2c2c2c2c"
    "2c2c2cffff0000000000000001ff0000000000000060ff01fbff01ffff08",
    // triangles drawn so flat that the rest of a solve leaves the bounds
    "004e313653753d0000373d00ff373d0011ff0100000100000100ffee110401000100013d000000ffffd50000"
    "55726661805800ffff010000002919110100040100010000113f004e30385375726661636569da0100537572"
    "6661636569da010000ffff00005a5a5a5a5a5a5aa35b5a055afe000008",
    // values of 1e29 with a tensor that no factor resolves: the report has the residual
    "f623b7a3a3a3a3a3a3a3a3a3a3a3a3fffffff7ffff01ff1304020100001df51d0300386f80007d0000000001"
    "0000000d0000ffffffffffffff0900f05655ffff0000f711ffffffffffffff17aa0000ffff010000aab00010"
    "2aaaaa418a0100111141040100536d6d6d6d6d6d6d6d6d6d6d6d6d6d6d6da36dffffffffffffff1ffffff7ff"
    "ff01ff1304020100001df51d0380396f00007d1d0001b0100bfffffe25aaaa4140c801fef8b00010a9aa0000"
    "ffff01110009fef8b00010a9aa0000ffff01a9a9a90000aab000102aaaaa418a0100111141040100536d1000"
    "6d126d6d636d6d6d6d6d6d8000ffff291100604e5374368b0a048b01",
    // a blur whose error was relative to the values, not to their contrast
    "3ad55500ffffff21757266618000ffff010000002911110100040100010000113f004e313653757266616365"
    "69da010000ffff0000010075726661f8fffeff8000ff55555555ff56b7fffffff7ffff01ff1304020100001d"
    "f51d03555555ff010010010000d50026b000a9d3aaaa41ece8e83aaa00117240c82301fef800b0b0008a8a5c"
    "555555555555d5b0005504726661000066618000ffff010000002911110100040100010000113f004e313653"
    "75726661636569da010000ffff0000010075726661f8fffeff8000ff55555555ff56b7fffffff7ffff01ff13"
    "0402010000011011ff00f6fe0100000100757266020100001dfd1d03545555d500b0b000a9d3aaaa41e8e8e8"
    "38aa00117240c8f801feff00fe1011ff00f6fe0100f8a9aaaaffff01ff0213040100001df5e8e8e838aa0011"
    "724010f702ff01ffff13047266610000ff00ffff8001ff00011011ff00f6fe0100000100757266020100001d"
    "fd1d03545555d500b0b000a9d3aaaa41e8e8e838aa00117240c8f801feff00fe1011ff00f6fe0100f8a9aaaa"
    "418a2a1d8ea360",
    // a pass in single precision whose iterates grew until double precision lost the residual
    "0000ffff010000010000111104010001000092193fffffffffffffff8b8b8bff1e0021ff00ffff0400ff0100"
    "000000ffff0fffff0100000100ff0100010000",
    // values that differ by 1e-5 of their size: round-off changes the energy by its mixed term, too
    "000053068b613b614f00ff00e8fefe00000000510000efffffd521000100000800075555555555555900ffff"
    "ff4f",
    // values of 1e29 again, on which a factorisation fails
    "f623b7a3a3a3a3a3a3a3a3a3a3a3a3fffffff7ffff01ff1304020100001df51d0300386f80007d0000000001"
    "0000000d0000004140c801fef8b000f05655ffff000011f7ffffffffffffff17aa0000ffff010000aab00010"
    "2aaaaa418a0100111141040100536d6d6d6d6d6d6d6d6d6d6d6d6d6d6d6d6da3a3a3a3a3a3a3a3fffffff7ff"
    "ff01ff1304020100001df51d0380396f00007d1d0021b0100bfffffe25aaaa4140c801fef8b00010a9aa0000"
    "ffff01110009fef8b00010a9aa0000ffff010000aab000102aaaaa418a0100111141040100536d10006d126d"
    "feffffffffffff1f6d6d6d6d6d6d6d6d8000ffff291100604e5374368b08048b01",
    // a harmonic map whose multigrid failed, for which no other method was tried
    "9d00010000110146da0005000004010001ff890100ff00016affff00006aff7fffff1d0004010001ff890138"
    "35321d01215959595959595959595959592c59052c2ced2c2c7a2c0201d4ffdeded3f9ff04a37f2c2c2ced2e"
    "2c2c080200f32e0001252100ffffdfffff01000000010000008e8e8e8e8e8e8e8e868e8e8e8e8e8e8e8e8eff"
    "72ffffffff1fffffffff35ffffa952ffa85656565656a94bff1fffff06ffff30ffffff0000ff112ad901ff3d"
    "3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d012e"
    "0000000000003d3dcfcfcf11010080fff9003d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d3d"
    "3d3d3d3d3d3d3d3d0008d7d7",
    // values of 1e85, whose least differences vanished when they were made small
    "08ff800000ff6a05646464cf18730001001600550000ff24ff800000ff6a730001001600550000ff24ee11cf"
    "042f00000080ff01002800002005a3fff32e16c1b05694e8326e00fffffb5c000a010110ff23d901f1f1f1f1"
    "f7483202effe39c6c6d7d71900190000550000ff24ff800000ff6a730001001600550000ff24ee11cf042f00"
    "000080ff01002800002005a3fff32e16c1b05694e8326e00fffffb5c000a010110ff23d901f1f1f1f1f74832"
    "02effe39c6c6d7d719001900fffff32e0001010000ff1000ff11ff01ff000201ee11cf042f00000080ff01f3"
    "000200000028010011ffff0100000f110104b704b700000100bf01110104b704ff0672000500357060f41900"
    "ffffb70000fffb5c000a010110ff23d9010014f1f1f1f1f7483202effe39c6c6d7d719001900ffff01280007"
    "fffff32e0001010000ff1000ff11ff01ff000201ee11cf042f00000080ff01f3000200000028010011ffff01"
    "00000f110104b704b700000100bf01110104b704ff0672000500357060f41900ffffb70000fffb5c000a0101"
    "10ff23d9010014f1f1f1f1f7483202effe39c6c6d7d719001900ffff012800070549ff11da0002010100ffff"
    "60",
    // a needle on which the minimiser left the range of numbers, and its gap counted as zero
    "f7fc3aff011f0000180001dc004a11f7fc31ef01ff0011f7fc31ef01ff00b0180001b1004a11001ec700af8f"
    "89b10049113aff011f0000180001b1004a11f7001ec700af8f8900130013008f0000003b1a1221",
    // one triangle without energy, whose round-off made the smoothing negative
    "0000000025000300fffcfd2f2ffbfb2a3d0000000000fefe0bff00000004070000000000ff402ffbbfff2f12e23d"
    "3d3d3dfbfb0000003d3d3d010bff8c00d5",
    // triangles that cover each other, which shrank to a point when their mesh was denoised
    "2f010200080000100000000022001a32ffcc08ff08ccce14c4ffccdffffc0032d9ffffff000000000000003affff"
    "ff051b411526265d5d5d5d26cc41322b",
  };
  for (const std::string& digits : found)
  {
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = 0; i < digits.size(); i += 2)
    {
      const std::string pair = digits.substr(i, 2);
      bytes.push_back(static_cast<std::uint8_t>(std::strtoul(pair.c_str(), nullptr, 16)));
    }
    EXPECT_NO_THROW(RunFromBytes(bytes.data(), bytes.size())) << digits;
  }
}
