#include "core/accuracy/where_next.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/fixtures/unloaded_day.h"

// Errors put into the readings of a day that an arm fits exactly, by the tests' own kinematics.

namespace stiffscope {
namespace where_test {

using diagnosis::WhereTable;

/// A day whose readings are those of the fitted arm, with a noise that is declared and not there.
class WhereLeft : public ::testing::Test {
 protected:
  static constexpr int kPostures = 40;
  static constexpr double kNoise = 10e-6;  // m

  WhereLeft() {
    Noise noise(3);
    UnloadedSpec exact;
    exact.noise = 1e-9;
    exact.postures = kPostures;
    calibration::Calibration calibrated = calibration::calibrate(unloadedCampaign(exact, noise), {});
    EXPECT_TRUE(calibrated.reason.empty());
    fit = calibrated.geometry().fit;
    fit.weights.assign(3 * kPostures, 1.0);
    day = std::move(calibrated.day);
    for (calibration::Posture& posture : day.postures) {
      for (calibration::Reading& reading : posture.readings)
        reading.covariance = kNoise * kNoise * Eigen::Matrix3d::Identity();
    }
    chain = exact.built;
    on_flange = exact.on_flange;
    tracker_from_base = exact.tracker_from_base;
  }

  /// Adds to each reading what `error` says, in base_link.
  template <class Error>
  void disturb(const Error& error) {
    for (calibration::Posture& posture : day.postures) {
      for (calibration::Reading& reading : posture.readings)
        reading.point += tracker_from_base.linear() * error(posture, reading);
    }
  }

  const WhereTable& table(const std::string& by) {
    tables = accuracy::whereLeft(day, fit);
    for (const WhereTable& one : tables) {
      if (one.by == by) return one;
    }
    throw std::logic_error("no table " + by);
  }

  calibration::UnloadedDay day;
  calibration::ArmFit fit;
  ChainArm chain;
  std::vector<Eigen::Vector3d> on_flange;
  Eigen::Isometry3d tracker_from_base;
  std::vector<WhereTable> tables;
};

// 30 um along base_link's x in one of three reflectors. The readings' own nanometre is a part in 10^4 of it.
TEST_F(WhereLeft, NamesTheReflectorAndTheAxis) {
  disturb([](const auto&, const calibration::Reading& reading) {
    return Eigen::Vector3d(reading.target == 1 ? 30e-6 : 0.0, 0.0, 0.0);
  });
  const WhereTable reflectors = table("reflector");
  ASSERT_EQ(reflectors.rows.size(), 3u);
  EXPECT_EQ(reflectors.rows[1].name, "P11");
  EXPECT_NEAR(reflectors.rows[1].rms, 30e-6 / std::sqrt(3.0), 1e-8);
  EXPECT_NEAR(reflectors.rows[1].noise, kNoise, 1e-12);
  EXPECT_NEAR(reflectors.rows[1].share, 1.0, 1e-3);
  EXPECT_LT(reflectors.rows[0].rms, 1e-8);
  const WhereTable axes = table("base axes");
  EXPECT_NEAR(axes.rows[0].rms, 30e-6 / std::sqrt(3.0), 1e-8);  // a third of the readings
  EXPECT_LT(axes.rows[1].share + axes.rows[2].share, 1e-3);
  const WhereTable beam = table("beam");
  EXPECT_NEAR(beam.rows[0].share + beam.rows[1].share, 1.0, 1e-9);
}

TEST_F(WhereLeft, TellsAlongTheBeamFromAcross) {
  const Eigen::Vector3d station = tracker_from_base.inverse().translation();
  disturb([&](const auto& posture, const calibration::Reading& reading) {
    const Eigen::Vector3d at = chain.flangeAt(posture.q) * on_flange[static_cast<std::size_t>(reading.target)];
    return Eigen::Vector3d(20e-6 * (at - station).normalized());
  });
  const WhereTable beam = table("beam");
  EXPECT_NEAR(beam.rows[0].rms, 20e-6, 1e-8);
  EXPECT_NEAR(beam.rows[0].share, 1.0, 1e-3);
  EXPECT_GT(beam.rows[0].significance, 5.0);
  EXPECT_LT(beam.rows[1].significance, 0.0);  // declared noise that is not there
}

// A turn of one joint alone by another angle in every posture. What joint 4 explains of a posture is all of it: the sum
// of squares over the postures is that of the errors.
TEST_F(WhereLeft, ATurnOfOneJointIsItsOwn) {
  double squares = 0.0;
  disturb([&](const calibration::Posture& posture, const calibration::Reading& reading) {
    const auto frames = chain.framesAt(posture.q);
    const Eigen::Vector3d axis = frames[3].linear() * chain.axis[3];
    const Eigen::Vector3d at = frames[6] * on_flange[static_cast<std::size_t>(reading.target)];
    const double angle = 100e-6 * std::sin(2.0 + 5.0 * posture.q[3]);
    const Eigen::Vector3d error = angle * axis.cross(at - frames[3].translation());
    squares += error.squaredNorm();
    return error;
  });
  const WhereTable joints = table("joint");
  EXPECT_TRUE(joints.overlaps);
  EXPECT_NEAR(joints.explained, 1.0, 1e-3);
  double shares = 0.0;
  for (const diagnosis::WhereRow& row : joints.rows) {
    shares += row.share;
    if (row.name != "joint 4") {
      EXPECT_LT(row.rms, joints.rows[3].rms) << row.name;
    }
  }
  EXPECT_NEAR(shares, joints.explained, 1e-9);
  EXPECT_NEAR(joints.rows[3].rms, std::sqrt(squares / kPostures), 1e-3 * std::sqrt(squares / kPostures));
}

TEST_F(WhereLeft, FindsTheLastQuarterAndThePosture) {
  disturb([](const calibration::Posture& posture, const auto&) {
    return Eigen::Vector3d(0.0, 0.0, posture.pose == kPostures - 1 ? 50e-6 : 0.0);
  });
  const WhereTable times = table("time");
  ASSERT_EQ(times.rows.size(), 4u);
  EXPECT_NEAR(times.rows[3].share, 1.0, 1e-3);
  // Ten postures in the last quarter, one of them 50 um off in one of three coordinates.
  EXPECT_NEAR(times.rows[3].rms, 50e-6 / std::sqrt(30.0), 1e-8);
  const WhereTable postures = table("posture");
  ASSERT_EQ(postures.rows.size(), static_cast<std::size_t>(kPostures));
  EXPECT_EQ(postures.rows.back().name, std::to_string(kPostures));
  EXPECT_NEAR(postures.rows.back().rms, 50e-6 / std::sqrt(3.0), 1e-8);
}

TEST_F(WhereLeft, ReadingsOfNoWeightAreLeftOut) {
  disturb([](const auto&, const calibration::Reading& reading) {
    return Eigen::Vector3d(reading.target == 2 ? 1e-3 : 0.0, 0.0, 0.0);
  });
  std::size_t at = 0;
  for (const calibration::Posture& posture : day.postures) {
    for (const calibration::Reading& reading : posture.readings) fit.weights[at++] = reading.target == 2 ? 0.0 : 1.0;
  }
  const WhereTable reflectors = table("reflector");
  ASSERT_EQ(reflectors.rows.size(), 2u);
  EXPECT_LT(std::max(reflectors.rows[0].rms, reflectors.rows[1].rms), 1e-8);
}

}  // namespace where_test
}  // namespace stiffscope
