#include <gtest/gtest.h>

#include <cstdio>
#include <map>
#include "core/frames/frames.h"
#include "tests/fixtures/simulated_lab.h"

// Propagated uncertainties held against Monte Carlo (GUM Supplement 1): a noise-free day is made with the tests' own
// kinematics, a tracker's noise is drawn on every reading 2000 times, and each time everything is measured anew. The
// stated 95 % regions must hold the truth in 93-97 %: 2000 draws have a standard error of 0.5 %, and the factor
// chi2/dof, which is applied only above 1, adds about 1 %. The truth is what the noise-free day gives, which
// frames_test holds against the arm to 1e-9 m.

namespace stiffscope {
namespace propagation_test {

constexpr int kDraws = 2000;
constexpr double kAlong = 6e-6, kAcross = 2.5e-5;  // m
constexpr double kScale = 2e-5;                    // relative: twenty times a tracker's, for it to show
const std::map<int, double> kChiSquare95{{1, 3.8415}, {3, 7.8147}, {6, 12.5916}, {9, 16.9190}};

/// Axes 1-4 a millimetre and a milliradian off; the wrist's axes meet. Axis 1 stands at -14 degrees when the others are
/// swept, so that these are turned back about it.
SimulatedLab propagationLab() {
  SimulatedLab lab;
  lab.withoutMasses();
  Noise noise(32);
  const ChainArm disturbed = lab.nominal.disturbed(noise, 1e-3, 1e-3);
  for (std::size_t j = 0; j < 4; ++j) lab.actual.to_joint[j] = disturbed.to_joint[j];
  // Angles are given as 0 to 90 degrees: one a fraction of its uncertainty below 90 is folded, and too good. Here axis
  // 4 stands clear of the right angle to axis 3; those of 4 to 5 and 5 to 6 are exactly right, where folding changes no
  // error's size.
  lab.actual.to_joint[3].rotate(Eigen::AngleAxisd(2e-3, Eigen::Vector3d::UnitZ()));
  return lab;
}

campaign::Campaign sweptOver(const SimulatedLab& lab, double arc_deg) {
  campaign::Campaign campaign = lab.empty();
  campaign.tracker = campaign::Tracker{"", kAlong, 0.0, kAcross, 0.0, Eigen::Vector3d::Zero()};
  campaign.circle_sweeps = campaign::CircleSweeps{"circle_sweeps.csv", campaign::PointFrame::tracker, {}};
  constexpr int kStops = 13;
  for (int axis = 0; axis < 6; ++axis) {
    for (int stop = 0; stop < kStops; ++stop) {
      JointVector q = axis == 0 ? JointVector(JointVector::Zero(6)) : degrees(-14, axis > 2 ? 8 : 0, 0, 0, 0, 0);
      q[axis] += radians(arc_deg * (static_cast<double>(stop) / kStops - 0.5));
      for (std::size_t k = 0; k < 3; ++k) {
        campaign.circle_sweeps->rows.push_back(
            {axis, std::to_string(stop), static_cast<int>(k), q, campaign::kNotGiven, lab.seen(q, k)});
      }
    }
  }
  lab.addWristSweep(campaign);
  campaign.wrist_sweep->rows.resize(60);  // 20 readings of each reflector
  return campaign;
}

/// A reading as this tracker makes it: its own noise, and the scale error that it makes in all.
Eigen::Vector3d read(const Eigen::Vector3d& point, double scale, Noise& noise) {
  return (1.0 + scale) * point + noise.draw(seenFromOrigin(point, kAlong, kAcross));
}

campaign::Campaign measuredAnew(campaign::Campaign campaign, double scale, Noise& noise) {
  for (auto& reading : campaign.circle_sweeps->rows) reading.point = read(reading.point, scale, noise);
  for (auto& reading : campaign.wrist_sweep->rows) reading.point = read(reading.point, scale, noise);
  return campaign;
}

class Coverage {
 public:
  void add(const std::string& what, const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance) {
    // Metres beside radians: rows of one size first.
    const Eigen::VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::MatrixXd even = scale.asDiagonal() * covariance * scale.asDiagonal();
    const Eigen::VectorXd off = scale.cwiseProduct(error);
    inside_[what] += off.dot(even.ldlt().solve(off)) < kChiSquare95.at(static_cast<int>(error.size()));
  }
  double of(const std::string& what) const { return static_cast<double>(inside_.at(what)) / kDraws; }
  void expect() const {
    for (const auto& [what, count] : inside_) {
      std::printf("coverage of %s: %.1f %%\n", what.c_str(), 100.0 * of(what));
      // Of 2000 draws the share scatters by 0.5 %: five of that.
      EXPECT_GT(of(what), 0.925) << what;
      EXPECT_LT(of(what), 0.975) << what;
    }
  }

 private:
  std::map<std::string, int> inside_;
};

metrology::FrameError errorOfR0(const frames::Frames& truth, const frames::Frames& found) {
  return metrology::frameError(truth.arm.r0_from_points.inverse(), found.arm.r0_from_points.inverse());
}

void addGeometry(const frames::Frames& truth, const frames::Frames& found, Coverage& coverage) {
  constexpr frames::FramesLayout kAt(6);
  const Eigen::MatrixXd total = found.covariance.total();
  const auto block = [&](Eigen::Index at, Eigen::Index size) { return total.block(at, at, size, size); };
  coverage.add("R0", errorOfR0(truth, found), block(kAt.kR0, 6));
  coverage.add("the wrist centre", found.wrist.centre_in_r0 - truth.wrist.centre_in_r0, block(kAt.wrist_centre, 3));
  Eigen::Vector3d radii, lengths;
  for (int k = 0; k < 3; ++k) {
    radii[k] = found.wrist.radii[static_cast<std::size_t>(k)] - truth.wrist.radii[static_cast<std::size_t>(k)];
    lengths[k] = found.links[static_cast<std::size_t>(k)].distance - truth.links[static_cast<std::size_t>(k)].distance;
  }
  coverage.add("the radii together", radii, block(kAt.radii, 3));
  coverage.add("lengths 1-2, 2-3, 3-4 together", lengths, block(kAt.kDistances, 3));
  coverage.add("the mean of Table I", found.wrist.table_mean_in_r0 - truth.wrist.table_mean_in_r0,
               found.wrist.table_mean_covariance);
  for (std::size_t i = 0; i < 5; ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    const auto name = std::to_string(i + 1) + "-" + std::to_string(i + 2);
    coverage.add("length " + name, Eigen::VectorXd::Constant(1, found.links[i].distance - truth.links[i].distance),
                 block(kAt.kDistances + row, 1));
    coverage.add("angle " + name, Eigen::VectorXd::Constant(1, found.links[i].angle - truth.links[i].angle),
                 block(kAt.angles + row, 1));
  }
}

void expectCoverage(double arc_deg) {
  const SimulatedLab lab = propagationLab();
  campaign::Campaign clean = sweptOver(lab, arc_deg);
  clean.tracker->scale_sigma = kScale;
  const frames::Frames truth = frames::measureFrames(clean);
  Noise noise(static_cast<std::uint64_t>(arc_deg));
  Coverage coverage;
  for (int k = 0; k < kDraws; ++k) {
    const double scale = kScale * noise.normal();
    const frames::Frames found = frames::measureFrames(measuredAnew(clean, scale, noise));
    ASSERT_TRUE(found.arm.points_placed && found.wrist.measured);
    addGeometry(truth, found, coverage);
  }
  coverage.expect();
}

TEST(PropagationCoverage, SweepsOver40Degrees) { expectCoverage(40.0); }
TEST(PropagationCoverage, SweepsOver90Degrees) { expectCoverage(90.0); }
TEST(PropagationCoverage, FullTurns) { expectCoverage(360.0); }

TEST(Propagation, ConsecutiveLinksShareAnAxis) {
  const frames::Frames frames = frames::measureFrames(sweptOver(propagationLab(), 40.0));
  const auto& total = frames.covariance.readings;
  const Eigen::Index one = frames::FramesLayout::kDistances, two = one + 1;
  EXPECT_GT(std::abs(total(one, two)) / std::sqrt(total(one, one) * total(two, two)), 0.05);
  EXPECT_NEAR(*frames.links[1].distance_sd, std::sqrt(total(two, two)), 1e-15);
  EXPECT_EQ(frames.links[1].distance_sag_sd, 0.0);
}

TEST(Propagation, NothingIsStatedWhereR0IsNotPlaced) {
  campaign::Campaign campaign = sweptOver(propagationLab(), 90.0);
  std::erase_if(campaign.circle_sweeps->rows, [](const campaign::CircleReading& reading) { return reading.axis == 1; });
  const frames::Frames frames = frames::measureFrames(campaign);
  EXPECT_TRUE(frames.covariance.total().isZero());
  for (const frames::LinkGeometry& link : frames.links) EXPECT_FALSE(link.distance_sd);
}

/// A day of an arm that sags under masses that its URDF states.
std::pair<SimulatedLab, campaign::Campaign> saggingDay() {
  SimulatedLab lab = propagationLab();
  lab.nominal = lab.actual = exampleChain();
  lab.compliance = exampleCompliance();
  campaign::Campaign campaign = sweptOver(lab, 90.0);
  for (campaign::CircleReading& reading : campaign.circle_sweeps->rows)
    reading.point = lab.seen(lab.settled(reading.q), static_cast<std::size_t>(reading.target));
  for (campaign::WristReading& reading : campaign.wrist_sweep->rows)
    reading.point = lab.seen(lab.settled(reading.q), static_cast<std::size_t>(reading.target));
  return {lab, campaign};
}

// The sag goes with mass times compliance, so that masses 4 % heavier move everything as compliances 4 % larger do.
TEST(Propagation, MassesDeclaredUncertainMoveAsCompliancesDo) {
  auto [lab, campaign] = saggingDay();
  frames::Frames start = frames::measureFrames(campaign);
  for (int round = 0; round < 2; ++round) start = frames::refineFrames(campaign, start, lab.compliance);
  const frames::Frames plain = frames::refineFrames(campaign, start, lab.compliance);
  campaign.mass_sigma = 0.04;
  const frames::Frames stated = frames::refineFrames(campaign, start, lab.compliance);
  const frames::Frames softer = frames::refineFrames(campaign, start, 1.04 * lab.compliance);
  constexpr frames::FramesLayout kAt(6);
  EXPECT_TRUE(plain.covariance.by_masses.isZero(0.0));
  for (std::size_t i = 0; i < 3; ++i) {
    const double moved = softer.links[i].distance - plain.links[i].distance;
    // A hundredth: own weight turns with the sagged arm, once more by the compliance alone.
    EXPECT_NEAR(stated.covariance.by_masses[kAt.kDistances + static_cast<Eigen::Index>(i)], moved,
                0.01 * std::abs(moved) + 1e-9);
    EXPECT_NEAR(*stated.links[i].distance_sd, std::hypot(*plain.links[i].distance_sd, moved),
                0.01 * std::abs(moved) + 1e-9);
  }
  EXPECT_GT(stated.covariance.by_masses.segment<3>(kAt.kDistances).norm(), 1e-5);
  EXPECT_LT((errorOfR0(plain, softer) - stated.covariance.by_masses.head<6>()).norm(),
            0.01 * errorOfR0(plain, softer).norm());
}

TEST(Propagation, StiffnessesOfTheSagByMonteCarlo) {
  // The sag taken off by compliances drawn from a covariance, 5 % each and 1-3 correlated: how R0, links and wrist
  // scatter. 400 draws know a standard deviation to 3.5 %; 12 % is over three of that.
  const auto [lab, campaign] = saggingDay();
  JointMatrix half = JointMatrix(0.05 * exampleCompliance().asDiagonal());
  half(1, 0) = half(2, 1) = -0.03 * exampleCompliance()[1];
  frames::Frames start = frames::measureFrames(campaign);
  for (int round = 0; round < 2; ++round) start = frames::refineFrames(campaign, start, lab.compliance);
  const frames::Frames stated =
      frames::refineFrames(campaign, start, lab.compliance, JointMatrix(half * half.transpose()));

  Noise noise(9);
  constexpr int kSagDraws = 400;
  Eigen::Matrix<double, 10, 1> squares = Eigen::Matrix<double, 10, 1>::Zero(), expected;
  for (int k = 0; k < kSagDraws; ++k) {
    JointVector z(6);
    for (int joint = 0; joint < 6; ++joint) z[joint] = noise.normal();
    const frames::Frames found = frames::refineFrames(campaign, start, lab.compliance + half * z);
    Eigen::Matrix<double, 10, 1> off;
    off << errorOfR0(stated, found), found.links[1].distance - stated.links[1].distance,
        found.wrist.centre_in_r0 - stated.wrist.centre_in_r0;
    squares += off.cwiseAbs2();
  }
  expected << stated.covariance.sag.diagonal().head<6>(),
      stated.covariance.sag(frames::FramesLayout::kDistances + 1, frames::FramesLayout::kDistances + 1),
      stated.covariance.sag.diagonal().segment<3>(frames::FramesLayout(6).wrist_centre);
  for (int i = 0; i < 10; ++i) {
    const double drawn = std::sqrt(squares[i] / kSagDraws), by_law = std::sqrt(expected[i]);
    EXPECT_NEAR(by_law, drawn, 0.12 * drawn + 1e-9) << i;  // 1 nm and 1 nrad: nothing moves it
  }
  EXPECT_GT(stated.links[1].distance_sag_sd, 1e-6);
  EXPECT_GT(std::abs(stated.links[1].distance_by_sag), 1e-4);  // tons on springs of 3e6 Nm/rad
}

}  // namespace propagation_test
}  // namespace stiffscope
