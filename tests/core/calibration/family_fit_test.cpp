#include "core/calibration/family_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "core/calibration/arm_fit.h"
#include "core/calibration/fitted_day.h"
#include "tests/fixtures/unloaded_day.h"

namespace stiffscope {
namespace family_fit_test {

using calibration::ArmFit;
using calibration::EffectPart;
using calibration::FamilyFit;
using calibration::LinearisedDay;
using calibration::LinearModel;
using calibration::Periodogram;
using calibration::UnloadedDay;
using calibration::UnloadedEffect;

/// Folds of fours, as a diagnosis has them.
calibration::LinearisationOptions folds(std::size_t most_postures = 2000) {
  calibration::LinearisationOptions options;
  options.most_postures = most_postures;
  options.inner_fold = [](int pose) { return (pose / 8) % 5; };
  options.outer_fold = [](int pose) { return (pose / 4) % 2; };
  return options;
}

/// A day without effects and its geometry. Effects are then added in the linear form that the columns have, so that
/// what must come out is exact.
struct CleanDay {
  UnloadedDay day;
  ArmFit geometry;

  explicit CleanDay(std::uint64_t seed, int postures = 80) {
    Noise noise(seed);
    UnloadedSpec spec = builtOtherwise(noise);
    spec.postures = postures;
    day = calibration::unloadedDay(unloadedCampaign(spec, noise));
    const std::vector<double> all(day.readings(), 1.0);
    geometry = calibration::fitArm(day, *calibration::placeArm(day, all), {}, {.weights = all});
  }

  UnloadedDay with(const EffectPart& part, const std::vector<double>& sizes) const {
    UnloadedDay other = day;
    const calibration::FittedDay fitted(day, geometry);
    const Eigen::Matrix3d points_from_base = geometry.place.base_from_points.linear().transpose();
    for (calibration::Posture& posture : other.postures) {
      const frames::PlacedPosture placed(fitted.arm(), posture.q);
      for (calibration::Reading& reading : posture.readings) {
        const calibration::ReflectorAt at = fitted.reflector(placed, reading);
        Eigen::Vector3d moved = Eigen::Vector3d::Zero();
        for (std::size_t k = 0; k < sizes.size(); ++k) {
          const calibration::EffectTerm& term = part.terms[k];
          moved += sizes[k] * (term.angles ? Eigen::Vector3d(placed.byAngles(at.position) * term.angles(posture))
                                           : term.offset(posture, at));
        }
        reading.point += points_from_base * moved;
      }
    }
    return other;
  }
};

LinearModel added(const LinearisedDay& day, const EffectPart& part) {
  LinearModel model = day.geometryAlone();
  const Eigen::MatrixXd columns = day.columnsOf(part.terms);
  day.add(part, {day.acrossGeometry(columns), columns.colwise().norm()}, 0.0, model);
  return model;
}

double sumOf(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

std::size_t familyOf(const FamilyFit& fits, UnloadedEffect effect) {
  const auto& families = fits.families();
  return static_cast<std::size_t>(
      std::find_if(families.begin(), families.end(), [&](const auto& family) { return family.effect == effect; }) -
      families.begin());
}

// Sums of products of some 700 numbers of order one: rounding stays far below this.
constexpr double kRounding = 1e-9;

TEST(LinearisedDay, WhatTheGeometryCanDoIsProjectedOff) {
  const CleanDay clean(61);
  const LinearisedDay day(clean.day, clean.geometry, folds());
  const Eigen::MatrixXd& basis = day.geometry();
  EXPECT_EQ(basis.cols(), 33);  // base 6, reflectors 9, axes 24, less 6 of the choice of frame
  EXPECT_LT((basis.transpose() * basis - Eigen::MatrixXd::Identity(basis.cols(), basis.cols())).norm(), 1e-6);
  EXPECT_LT((basis.transpose() * day.geometryAlone().residual).norm(), 1e-6);
  EXPECT_LT(day.acrossGeometry(basis).norm(), 1e-5);
}

TEST(LinearisedDay, AnEffectOfLinearFormIsTakenOffWhole) {
  const CleanDay clean(62);
  for (const EffectPart& part : {calibration::transmissionError(1, 3.0), calibration::targetMotion(clean.day, 1, 0.4),
                                 calibration::scaleError(0.5), calibration::frameError(0.3)}) {
    SCOPED_TRACE(idOf(part.effect));
    const UnloadedDay moved = clean.with(part, std::vector<double>(part.terms.size(), 200e-6));
    const LinearisedDay before(clean.day, clean.geometry, folds()), after(moved, clean.geometry, folds());
    EXPECT_GT(after.geometryAlone().squares(), 2.0 * before.geometryAlone().squares());
    const double without = added(before, part).squares(), left = added(after, part).squares();
    EXPECT_NEAR(left, without, 1e-6 * without);
  }
}

TEST(LinearisedDay, WhatTheGeometryDoesItselfAddsNothing) {
  const CleanDay clean(63);
  const LinearisedDay day(clean.day, clean.geometry, folds());
  // A reflector elsewhere all day is a reflector's place, and all elsewhere is the base's.
  for (const EffectPart& part : {calibration::targetMotion(clean.day, 0, -1.0), calibration::frameError(-1.0)}) {
    const LinearModel model = added(day, part);
    EXPECT_EQ(model.directions.cols(), 0);
    EXPECT_EQ(model.squares(), day.geometryAlone().squares());
  }
}

TEST(LinearisedDay, ATruePartPredictsPosturesThatWereLeftOut) {
  const CleanDay clean(64);
  const EffectPart part = calibration::transmissionError(1, 3.0);
  const UnloadedDay moved = clean.with(part, {100e-6, 0.0});
  const LinearisedDay day(moved, clean.geometry, folds());
  const LinearModel nothing = day.geometryAlone(), with = added(day, part);
  EXPECT_LT(day.heldOut(with), 0.6 * day.heldOut(nothing));
  EXPECT_LT(sumOf(day.heldOutByPosture(with)), 0.6 * sumOf(day.heldOutByPosture(nothing)));
  EXPECT_EQ(day.heldOutByPosture(with).size(), moved.postures.size());
  // Predicted is worse than fitted.
  EXPECT_GT(day.heldOut(with), with.squares());
}

/// With p parameters fitted to all but the rows that are judged, of n rows in all, these miss by 1 + p / (n - n /
/// folds) of the noise on the average over divisions, where the rows see all parameters alike.
TEST(LinearisedDay, OtherDivisionsIntoFoldsScatterAboutWhatFittingCosts) {
  const CleanDay clean(66);
  const LinearisedDay day(clean.day, clean.geometry, folds());
  const LinearModel nothing = day.geometryAlone();
  EXPECT_EQ(day.heldOutByDivision(nothing, 0).size(), 1u);
  const std::vector<double> sums = day.heldOutByDivision(nothing, 40);
  ASSERT_EQ(sums.size(), 41u);
  EXPECT_NEAR(sums.front(), sumOf(day.heldOutByPosture(nothing)), kRounding * sums.front());
  const double rows = static_cast<double>(day.rows()), parameters = static_cast<double>(day.geometry().cols());
  const double squares = nothing.squares() / (rows - parameters) * day.noise() * day.noise();
  const double expected = rows * squares * (1.0 + parameters / (rows / 2.0));
  EXPECT_NEAR(sumOf(sums) / 41.0, expected, 0.05 * expected);
  const auto [least, most] = std::minmax_element(sums.begin(), sums.end());
  EXPECT_GT(*most - *least, 0.005 * expected);
  EXPECT_LT(*most - *least, 0.2 * expected);
}

/// Two parameters of 720 equations: noise fitted by them is as much again wrong where it was not fitted.
TEST(LinearisedDay, APartThatIsNotThereDoesNotPredict) {
  const CleanDay clean(65);
  const LinearisedDay day(clean.day, clean.geometry, folds());
  int worse = 0;
  for (const double order : {3.0, 5.5, 8.0, 11.25, 17.0}) {
    const LinearModel with = added(day, calibration::transmissionError(1, order));
    worse += day.heldOut(with) > day.heldOut(day.geometryAlone()) ? 1 : 0;
  }
  EXPECT_GE(worse, 4);
}

TEST(LinearisedDay, ReflectorsThatErrTogetherAreWorthOne) {
  const CleanDay clean(66);
  const LinearisedDay day(clean.day, clean.geometry, folds());
  Noise noise(1);
  Eigen::VectorXd apart(day.rows()), together(day.rows());
  for (std::size_t k = 0; k < day.postures().size(); ++k) {
    const Eigen::Vector3d one = noise.normal3();
    for (Eigen::Index t = 0; t < 3; ++t) {
      apart.segment<3>(day.firstRow(k) + 3 * t) = noise.normal3();
      together.segment<3>(day.firstRow(k) + 3 * t) = one;
    }
  }
  // 240 means of three: their squares scatter by sqrt(2 / 240), a tenth.
  EXPECT_LT(day.designEffect(apart), 1.3);
  EXPECT_NEAR(day.designEffect(together), 3.0, kRounding);
}

TEST(LinearisedDay, ChoosesNeighboursByFours) {
  const CleanDay clean(67);
  const LinearisedDay day(clean.day, clean.geometry, folds(40));
  ASSERT_EQ(day.postures().size(), 40u);
  for (std::size_t k = 0; k < 40; ++k) EXPECT_EQ(day.postures()[k], 8 * (k / 4) + k % 4);
}

TEST(FamilyFit, AnEffectIsFoundByItsOwnFamily) {
  const CleanDay clean(71);
  struct Case {
    EffectPart part;
    std::vector<double> sizes;
  };
  for (const Case& one : {Case{calibration::transmissionError(0, 20.75), {60e-6, 20e-6}},
                          Case{calibration::targetMotion(clean.day, 2, 0.4), {150e-6, 0.0, -100e-6}},
                          Case{calibration::scaleError(0.5), {50e-6}}}) {
    SCOPED_TRACE(idOf(one.part.effect));
    const UnloadedDay moved = clean.with(one.part, one.sizes);
    const LinearisedDay before(clean.day, clean.geometry, folds()), day(moved, clean.geometry, folds());
    const FamilyFit fits(day, 1e-3, 6);
    const LinearModel nothing = day.geometryAlone();
    const auto model =
        fits.fit(familyOf(fits, one.part.effect), nothing, fits.productsOf(nothing), static_cast<double>(day.rows()));
    ASSERT_TRUE(model.has_value());
    ASSERT_FALSE(model->parts.empty());
    EXPECT_EQ(model->parts.front().detail, one.part.detail);
    EXPECT_LT(*model->parts.front().chance, 1e-6);
    // To noise: a time that is a posture off, or an order that is a quarter off, costs a little.
    EXPECT_LT(model->squares(), 1.05 * before.geometryAlone().squares());
  }
}

TEST(FamilyFit, ACleanDayHasNoneOfThem) {
  const CleanDay clean(72);
  const LinearisedDay day(clean.day, clean.geometry, folds());
  const FamilyFit fits(day, 1e-3, 6);
  const LinearModel nothing = day.geometryAlone();
  const FamilyFit::Products beside = fits.productsOf(nothing);
  for (std::size_t family = 0; family < fits.families().size(); ++family) {
    EXPECT_FALSE(fits.fit(family, nothing, beside, static_cast<double>(day.rows())).has_value())
        << idOf(fits.families()[family].effect);
  }
}

TEST(FamilyFit, FallIsOfTheLogarithmOfSquares) {
  EXPECT_NEAR(FamilyFit::fall(std::exp(1.0), 1.0, 7.0), 7.0, kRounding);
  EXPECT_EQ(FamilyFit::fall(2.0, 2.0, 100.0), 0.0);
}

TEST(LinearisedDay, KeepsThePartsOfTheEffectsThatStay) {
  const CleanDay clean(73);
  const LinearisedDay day(clean.day, clean.geometry, folds());
  EffectPart wave = calibration::transmissionError(1, 3.0), scale = calibration::scaleError(0.5);
  wave.penalty = 5.0, scale.penalty = 3.0;
  LinearModel both = day.geometryAlone();
  for (const EffectPart& part : {wave, scale}) {
    const Eigen::MatrixXd columns = day.columnsOf(part.terms);
    day.add(part, {day.acrossGeometry(columns), columns.colwise().norm()}, part.penalty, both);
  }
  const LinearModel one =
      day.keeping(both, [](const EffectPart& part) { return part.effect != UnloadedEffect::scale_error; });
  EXPECT_EQ(both.directions.cols(), 3);
  EXPECT_EQ(both.penalty, 8.0);
  ASSERT_EQ(one.parts.size(), 1u);
  EXPECT_EQ(one.penalty, 5.0);
  EXPECT_NEAR(one.squares(), added(day, wave).squares(), kRounding * one.squares());
}

/// The peak's gain is what the squares fall by with that part in the model.
TEST(Periodogram, GainIsTheFallOfSquares) {
  const CleanDay clean(74);
  const UnloadedDay moved = clean.with(calibration::transmissionError(3, 7.5), {150e-6, 0.0});
  const LinearisedDay day(moved, clean.geometry, folds());
  const LinearModel nothing = day.geometryAlone();
  const Periodogram periodogram(day.equations(), day.postures(), day.day(), day.geometry(), nothing.residual);
  for (const calibration::PeriodicPeak& peak : periodogram.peaks()) {
    const LinearModel with = added(day, calibration::transmissionError(peak.joint, peak.order));
    EXPECT_NEAR(peak.gain, nothing.squares() - with.squares(), 1e-6 * nothing.squares()) << "joint " << peak.joint + 1;
  }
}

TEST(Periodogram, ACopyIsTheSameAndItsOwn) {
  const CleanDay clean(75);
  const EffectPart part = calibration::transmissionError(3, 7.5);
  const UnloadedDay moved = clean.with(part, {150e-6, 0.0});
  const LinearisedDay day(moved, clean.geometry, folds());
  const LinearModel with = added(day, part);
  const Eigen::VectorXd& residual = day.geometryAlone().residual;
  const Periodogram original(day.equations(), day.postures(), day.day(), day.geometry(), residual);
  const auto gains = [](const Periodogram& periodogram) {
    std::vector<double> gains;
    for (const calibration::PeriodicPeak& peak : periodogram.peaks()) gains.push_back(peak.gain);
    return gains;
  };
  const std::vector<double> at_first = gains(original);
  Periodogram copy = original;
  EXPECT_EQ(gains(copy), at_first);
  copy.projectOff(with.directions, with.directions.transpose() * residual);
  EXPECT_EQ(gains(original), at_first);
  // The joint whose wave was projected off has noise left.
  EXPECT_LT(gains(copy)[3], 0.2 * at_first[3]);
}

}  // namespace family_fit_test
}  // namespace stiffscope
