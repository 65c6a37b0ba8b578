// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "Run/HarmonicMapSettings.h"
#include "Run/HeatSettings.h"
#include "Run/InterpolationSettings.h"
#include "Run/MumfordShahSettings.h"
#include "Run/SegmentationSettings.h"
#include "Run/TensorDiffusionSettings.h"
#include "Run/TextureSettings.h"
#include "Run/TotalVariationSettings.h"

#include <functional>
#include <memory>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

/// All models, for the tests of what every model promises.
namespace SurfaceDiffusion::Testing
{

/// The data that a model is run on.
enum class Content
{
  Scalars,
  Colors,
  UnitVectors,
  Nothing,
  ScalarsOnCells,
  ColorsOnCells,
  UnitVectorsOnCells
};

/// What a model does not promise.
enum class Exemption
{
  None,
  /// It starts on a coarser mesh, or has tangent planes where three sheets meet: by the numbering.
  Numbering,
  Energy, ///< its energy can rise: eps is halved, or the scheme is explicit
  Allocation ///< one solver is used for different systems in turn
};

/// A model with settings that take a way of their own through its code.
struct ModelKind
{
  std::string Name;
  /// The settings. The model that is made with them is written to `made`, if that is not null.
  std::function<std::shared_ptr<RunSettings>(Model** made)> Make;
  Content Data = Content::Scalars;
  Exemption From = Exemption::None;

  bool IsOnCells() const { return this->Data >= Content::ScalarsOnCells; }
  bool HasUnitVectors() const
  {
    return this->Data == Content::UnitVectors || this->Data == Content::UnitVectorsOnCells;
  }
  bool HasScalars() const
  {
    return this->Data == Content::Scalars || this->Data == Content::ScalarsOnCells;
  }
  int NumberOfComponents() const { return this->HasScalars() ? 1 : 3; }
};

inline void PrintTo(const ModelKind& kind, std::ostream* os)
{
  *os << kind.Name;
}

template <typename ModelSettings>
ModelKind MakeKind(std::string name, int steps, std::function<void(ModelSettings&)> set = {},
  Content data = Content::Scalars, Exemption from = Exemption::None)
{
  struct Watched : ModelSettings
  {
    Model** Made = nullptr;
    std::unique_ptr<Model> Make(ModelInputs& inputs, RunResult& result) const override
    {
      auto model = this->ModelSettings::Make(inputs, result);
      if (this->Made)
      {
        *this->Made = model.get();
      }
      return model;
    }
  };
  return { std::move(name),
    [=, set = std::move(set)](Model** made) -> std::shared_ptr<RunSettings>
    {
      auto settings = std::make_shared<Watched>();
      if constexpr (std::is_base_of_v<TimeSettings, ModelSettings>)
      {
        settings->NumberOfTimeSteps = steps;
      }
      if constexpr (std::is_same_v<TotalVariationSettings, ModelSettings>)
      {
        settings->AutomaticFidelity = false; // some kinds turn it on, which takes longer
      }
      if (set)
      {
        set(*settings);
      }
      settings->Made = made;
      return settings;
    },
    data, from };
}

/// Every model, with every scheme and every discretisation that it has.
inline std::vector<ModelKind> AllModelKinds()
{
  using Heat = HeatSettings;
  using TV = TotalVariationSettings;
  using Harmonic = HarmonicMapSettings;
  using Shah = MumfordShahSettings;
  using Tensor = TensorDiffusionSettings;
  using Texture = TextureSettings;
  using Segments = SegmentationSettings;
  using Spline = InterpolationSettings;
  const auto setImplicit = [](TV& s)
  { s.TimeIntegrator = SurfaceDiffusion::TimeIntegrator::Implicit; };
  const auto setSteady = [](TV& s)
  {
    s.Mode = TotalVariationMode::SteadyState;
    s.StopTolerance = 1e-2;
  };
  std::vector<ModelKind> kinds = {
    MakeKind<Heat>("Heat", 3),
    MakeKind<Heat>("HeatColors", 3, {}, Content::Colors),
    MakeKind<Heat>("HeatOnCells", 4, {}, Content::ColorsOnCells),
    MakeKind<Heat>("HeatFirstOrder", 3,
      [](Heat& s)
      {
        s.TimeIntegrator = SurfaceDiffusion::TimeIntegrator::FirstOrder;
        s.FidelityWeight = 0.5;
      }),
    MakeKind<Heat>("HeatExponential", 2,
      [](Heat& s)
      {
        s.TimeIntegrator = SurfaceDiffusion::TimeIntegrator::Exponential;
        s.MassMatrix = SurfaceDiffusion::MassMatrix::Mixed;
        s.FidelityWeight = 0.5;
      }),
    MakeKind<Heat>(
      "HeatExponentialOnCells", 2,
      [](Heat& s) { s.TimeIntegrator = SurfaceDiffusion::TimeIntegrator::Exponential; },
      Content::ColorsOnCells),
    MakeKind<Heat>("HeatPeriodic", 2, [](Heat& s) { s.Period = 1.5; }),
    MakeKind<Heat>(
      "HeatTangent", 3, [](Heat& s) { s.Vectors.Type = VectorType::Tangent; }, Content::UnitVectors,
      Exemption::Numbering),
    MakeKind<Heat>(
      "HeatTangentOnCells", 2,
      [](Heat& s)
      {
        s.Vectors = { VectorType::Tangent, VectorLaplacian::Viscous, NormalPart::Keep };
        s.FidelityWeight = 0.5;
      },
      Content::UnitVectorsOnCells, Exemption::Numbering),
    MakeKind<Heat>(
      "HeatTangentDiffuse", 2,
      [](Heat& s)
      {
        s.Vectors = { VectorType::Tangent, VectorLaplacian::Hodge, NormalPart::Diffuse };
        s.TimeIntegrator = SurfaceDiffusion::TimeIntegrator::Exponential;
        s.MassMatrix = SurfaceDiffusion::MassMatrix::Mixed;
      },
      Content::UnitVectors, Exemption::Numbering),
    MakeKind<Heat>("HeatDirected", 2,
      [](Heat& s)
      {
        s.AcrossDiffusivity = 0.2;
        s.FidelityWeight = 0.5;
      }),
    MakeKind<Heat>("HeatMultigrid", 2, [](Heat& s) { s.Solver = SolverMethod::Multigrid; }),
    MakeKind<Heat>("HeatDirect", 2, [](Heat& s) { s.Solver = SolverMethod::Direct; }),
    MakeKind<Heat>("HeatDelaunay", 1, [](Heat& s) { s.IntrinsicDelaunay = true; }),
    MakeKind<Heat>("HeatSteadyState", 1,
      [](Heat& s)
      {
        s.Mode = HeatMode::SteadyState;
        s.FidelityWeight = 0.5;
      }),
    MakeKind<Heat>("HeatDeblurring", 1,
      [](Heat& s)
      {
        s.Mode = HeatMode::SteadyState;
        s.FidelityWeight = 2.0;
        s.Blur.FWHM = 0.15;
      }),
    MakeKind<Heat>("HeatAutomaticFidelity", 2, [](Heat& s) { s.AutomaticFidelity = true; }),

    MakeKind<TV>("TotalVariation", 3),
    MakeKind<TV>(
      "TotalVariationPerChannel", 2, [](TV& s) { s.ChannelCoupling = ChannelCoupling::PerChannel; },
      Content::Colors),
    MakeKind<TV>("TotalVariationDirected", 2, [](TV& s) { s.AcrossDiffusivity = 0.2; }),
    MakeKind<TV>(
      "TotalVariationOnCells", 2, [](TV& s) { s.AutomaticFidelity = true; },
      Content::ScalarsOnCells),
    MakeKind<TV>("TotalVariationLaggedL1", 2, [](TV& s) { s.FidelityNorm = FidelityNorm::L1; }),
    MakeKind<TV>(
      "PeronaMalik", 2, [](TV& s) { s.EdgeFunction = EdgeFunctionKind::PeronaMalikRational; },
      Content::Colors),
    MakeKind<TV>("TotalVariationImplicit", 2, setImplicit, Content::Colors),
    MakeKind<TV>("TotalVariationL1", 2,
      [=](TV& s)
      {
        setImplicit(s);
        s.FidelityNorm = FidelityNorm::L1;
      }),
    MakeKind<TV>("TotalVariationSteadyState", 1, setSteady),
    MakeKind<TV>("TotalVariationSteadyStateOnCells", 1, setSteady, Content::ScalarsOnCells),
    MakeKind<TV>(
      "GeneralizedVariation", 1,
      [=](TV& s)
      {
        setSteady(s);
        s.Regularizer = Regularizer::TGV;
      },
      Content::Colors),
    MakeKind<TV>(
      "GeneralizedVariationOnCells", 1,
      [=](TV& s)
      {
        setSteady(s);
        s.Regularizer = Regularizer::TGV;
      },
      Content::ScalarsOnCells),
    MakeKind<TV>("TotalVariationDeblurring", 1,
      [=](TV& s)
      {
        setSteady(s);
        s.Blur.FWHM = 0.15;
        s.AutomaticBlurFidelity = false;
      }),
    MakeKind<TV>(
      "CrouzeixRaviart", 2, [](TV& s) { s.Discretization = Discretization::CrouzeixRaviart; }),
    MakeKind<TV>("CrouzeixRaviartSteadyState", 1,
      [=](TV& s)
      {
        setSteady(s);
        s.Discretization = Discretization::CrouzeixRaviart;
      }),
    MakeKind<TV>("CrouzeixRaviartImplicit", 2,
      [=](TV& s)
      {
        setImplicit(s);
        s.Discretization = Discretization::CrouzeixRaviart;
      }),

    MakeKind<Harmonic>("Harmonic", 2, {}, Content::UnitVectors),
    MakeKind<Harmonic>(
      "HarmonicExplicit", 2, [](Harmonic& s) { s.Scheme = HarmonicMap::Scheme::ExplicitReaction; },
      Content::UnitVectors, Exemption::Energy),
    MakeKind<Harmonic>(
      "HarmonicMinimizing", 1,
      [](Harmonic& s) { s.Scheme = HarmonicMap::Scheme::MinimizingMovement; },
      Content::UnitVectors),
    MakeKind<Harmonic>(
      "HarmonicLines", 2, [](Harmonic& s) { s.LineField = true; }, Content::UnitVectors),
    MakeKind<Harmonic>(
      "HarmonicLinesExplicit", 2,
      [](Harmonic& s)
      {
        s.Scheme = HarmonicMap::Scheme::ExplicitReaction;
        s.LineField = true;
      },
      Content::UnitVectors, Exemption::Energy),
    MakeKind<Harmonic>(
      "HarmonicDirect", 2,
      [](Harmonic& s)
      {
        s.Exponent = 2.0;
        s.Solver = SolverMethod::Direct;
      },
      Content::UnitVectors),
    MakeKind<Harmonic>(
      "HarmonicMultigrid", 2,
      [](Harmonic& s)
      {
        s.Exponent = 1.5;
        s.FidelityWeight = 0.1;
        s.Solver = SolverMethod::Multigrid;
      },
      Content::UnitVectors),
    MakeKind<Harmonic>(
      "HarmonicTangent", 2, [](Harmonic& s) { s.TangentTo = TangentTo::Surface; },
      Content::UnitVectors, Exemption::Numbering),
    MakeKind<Harmonic>(
      "HarmonicTangentLinesOnCells", 2,
      [](Harmonic& s)
      {
        s.TangentTo = TangentTo::Surface;
        s.LineField = true;
      },
      Content::UnitVectorsOnCells, Exemption::Numbering),
    MakeKind<Harmonic>("HarmonicOnCells", 2, {}, Content::UnitVectorsOnCells),

    MakeKind<Shah>("MumfordShah", 40, {}, Content::Scalars, Exemption::Energy),
    MakeKind<Shah>(
      "MumfordShahGivenScales", 20, [](Shah& s) { s.AutomaticThreshold = false; }, Content::Colors,
      Exemption::Energy),
    MakeKind<Shah>(
      "MumfordShahOnCells", 10, [](Shah& s) { s.AutomaticThreshold = false; },
      Content::ScalarsOnCells, Exemption::Energy),

    MakeKind<Tensor>("Beltrami", 2, {}, Content::Colors),
    MakeKind<Tensor>("BeltramiOnCells", 4, {}, Content::ScalarsOnCells),
    MakeKind<Tensor>(
      "BeltramiFixedMetric", 2, [](Tensor& s) { s.Metric = BeltramiFlow::Metric::Fixed; }),
    MakeKind<Tensor>(
      "CoherenceEnhancing", 2, [](Tensor& s) { s.Model = TensorModel::CoherenceEnhancing; },
      Content::Colors),
    MakeKind<Tensor>("EdgeEnhancing", 2, [](Tensor& s) { s.Model = TensorModel::EdgeEnhancing; }),

    MakeKind<Texture>(
      "TextureFirstOrder", 3,
      [](Texture& s) { s.TimeIntegrator = SurfaceDiffusion::TimeIntegrator::FirstOrder; },
      Content::Nothing),
    MakeKind<Texture>(
      "TextureDirect", 3, [](Texture& s) { s.Solver = SolverMethod::Direct; }, Content::Nothing),
    MakeKind<Texture>(
      "TextureCoarseStart", 40, [](Texture& s) { s.CoarseStartSize = 200; }, Content::Nothing,
      Exemption::Numbering),

    MakeKind<Segments>("Segmentation", 1, [](Segments& s) { s.StopTolerance = 0.1; }),
    MakeKind<Segments>(
      "SegmentationOfColors", 1,
      [](Segments& s)
      {
        s.NumberOfRegions = 3;
        s.StopTolerance = 0.1;
      },
      Content::ColorsOnCells),

    MakeKind<Spline>("Interpolation", 1, {}, Content::Scalars, Exemption::Allocation),
    MakeKind<Spline>(
      "InterpolationOfColors", 1,
      [](Spline& s)
      {
        s.KeepRange = true;
        s.ComputeError = true;
        s.CorrelationLength = 0.5;
      },
      Content::Colors, Exemption::Allocation),
    MakeKind<Spline>(
      "InterpolationRobust", 1,
      [](Spline& s)
      {
        s.Robust = true;
        s.LeaveOneOut = true;
      },
      Content::Scalars, Exemption::Allocation),
    MakeKind<Spline>(
      "InterpolationFree", 1, [](Spline& s) { s.Boundary = RimCondition::Free; },
      Content::ScalarsOnCells, Exemption::Allocation),
  };
  for (int k = 0; k < NumberOfKinetics; ++k)
  {
    const auto kinetics = static_cast<KineticsName>(k);
    kinds.push_back(MakeKind<Texture>(
      GetKinetics(kinetics).Name, 3, [kinetics](Texture& s) { s.Kinetics = kinetics; },
      Content::Nothing));
  }
  for (const auto& [lagged, implicit, steady, model] :
    { std::tuple("OpponentColors", "OpponentColorsImplicit", "OpponentColorsSteadyState",
        ColorModel::Opponent),
      std::tuple("ChromaticityBrightness", "ChromaticityBrightnessImplicit",
        "ChromaticityBrightnessSteadyState", ColorModel::ChromaticityBrightness) })
  {
    const auto setModel = [model = model](TV& s) { s.Color.Model = model; };
    const auto and_ = [=](const auto& set)
    {
      return [=](TV& s)
      {
        setModel(s);
        set(s);
      };
    };
    kinds.push_back(MakeKind<TV>(lagged, 2, setModel, Content::Colors));
    kinds.push_back(MakeKind<TV>(implicit, 2, and_(setImplicit), Content::Colors));
    kinds.push_back(MakeKind<TV>(steady, 1, and_(setSteady), Content::Colors));
  }
  return kinds;
}

} // namespace SurfaceDiffusion::Testing
