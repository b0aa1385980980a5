#include "core/interchange/state_join.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include "core/campaign/joint_reading.h"
#include "core/io/input_error.h"
#include "core/io/units.h"
#include "core/robot/kinematics.h"

namespace stiffscope::interchange {

namespace {

/// A reflector's places with the flange's, some of the day's, evenly.
struct ReflectorPlaces {
  std::vector<Eigen::Isometry3d> flange;
  std::vector<Eigen::Vector3d> points;
};

/// Postures that differ; load steps repeat one.
std::size_t posturesOf(const std::vector<const PlacedReading*>& readings) {
  std::set<PerJoint<double>> postures;
  for (const PlacedReading* reading : readings) postures.emplace(reading->figures.begin(), reading->figures.end());
  return postures.size();
}

std::vector<ReflectorPlaces> placesOf(const robot::Robot& robot, const campaign::JointConvention& convention,
                                      const std::vector<PlacedReading>& readings) {
  std::map<int, std::vector<const PlacedReading*>> by_target;
  for (const PlacedReading& reading : readings) by_target[reading.target].push_back(&reading);
  constexpr std::size_t kMost = 40, kFewest = 6;
  std::vector<ReflectorPlaces> all;
  for (const auto& [target, own] : by_target) {
    if (posturesOf(own) < kFewest) continue;
    const std::size_t count = std::min(kMost, own.size());
    ReflectorPlaces places;
    for (std::size_t i = 0; i < count; ++i) {
      const PlacedReading& reading = *own[i * own.size() / count];
      places.flange.push_back(robot::flangeAt(robot, robot::postureAt(robot, convention.angles(reading.figures))));
      places.points.push_back(reading.point);
    }
    all.push_back(std::move(places));
  }
  return all;
}

/// Sum of squared residuals at c, and its normal equations.
struct ChordEquations {
  double squares = 0.0;
  std::size_t pairs = 0;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
};

ChordEquations chordsAt(const ReflectorPlaces& places, const Eigen::Vector3d& on_flange, double scale) {
  ChordEquations equations;
  constexpr double kNoChord = 1e-3;  // m: of a posture taken twice there is no direction
  for (std::size_t k = 0; k < places.points.size(); ++k) {
    for (std::size_t l = 0; l < k; ++l) {
      const Eigen::Vector3d chord = places.flange[k] * on_flange - places.flange[l] * on_flange;
      const double length = chord.norm(), read = scale * (places.points[k] - places.points[l]).norm();
      const double residual = length - read;
      equations.squares += residual * residual;
      ++equations.pairs;
      if (length < kNoChord) continue;
      const Eigen::Vector3d gradient =
          (places.flange[k].linear() - places.flange[l].linear()).transpose() * chord / length;
      equations.normal += gradient * gradient.transpose();
      equations.right -= gradient * residual;
    }
  }
  return equations;
}

/// The least sum of squares over c, by Levenberg and Marquardt from one start.
ChordEquations fittedFrom(const ReflectorPlaces& places, Eigen::Vector3d on_flange, double scale) {
  ChordEquations best = chordsAt(places, on_flange, scale);
  double damping = 1e-3;
  constexpr int kSteps = 25;
  for (int step = 0; step < kSteps; ++step) {
    Eigen::Matrix3d damped = best.normal;
    damped.diagonal() *= 1.0 + damping;
    damped.diagonal().array() += 1e-12;
    const Eigen::Vector3d tried = on_flange + damped.ldlt().solve(best.right);
    const ChordEquations there = chordsAt(places, tried, scale);
    if (there.squares < best.squares) {
      const bool settled = best.squares - there.squares < 1e-9 * best.squares;
      on_flange = tried;
      best = there;
      damping *= 0.2;
      if (settled) break;
    } else {
      damping *= 10.0;
      if (damping > 1e9) break;
    }
  }
  return best;
}

double misfitOf(const std::vector<ReflectorPlaces>& all, double scale) {
  // Tools are longer than a hand and shorter than an arm.
  constexpr double kReach = 0.3;
  double squares = 0.0;
  std::size_t pairs = 0;
  for (const ReflectorPlaces& places : all) {
    ChordEquations best;
    best.squares = std::numeric_limits<double>::infinity();
    for (int start = 0; start < 7; ++start) {
      Eigen::Vector3d on_flange = Eigen::Vector3d::Zero();
      if (start > 0) on_flange[(start - 1) / 2] = start % 2 == 0 ? kReach : -kReach;
      const ChordEquations fitted = fittedFrom(places, on_flange, scale);
      if (fitted.squares < best.squares) best = fitted;
    }
    squares += best.squares;
    pairs += best.pairs;
  }
  return std::sqrt(squares / static_cast<double>(pairs));
}

campaign::JointReading& readingOf(std::vector<campaign::JointReading>& convention, int joint) {
  for (campaign::JointReading& one : convention) {
    if (one.joint == joint) return one;
  }
  convention.push_back({joint, 1.0, 0.0, -1});
  return convention.back();
}

struct Trial {
  OtherMeaning meaning;
  std::vector<campaign::JointReading> convention;
  double scale = 1.0;
};

std::vector<Trial> trialsOf(const std::vector<campaign::JointReading>& convention, int joints) {
  using Kind = OtherMeaning::Kind;
  std::vector<Trial> trials;
  const auto add = [&](OtherMeaning meaning, const auto& change) {
    Trial trial{meaning, convention};
    change(readingOf(trial.convention, meaning.joint));
    if (campaign::JointConvention(trial.convention, joints).invertible()) trials.push_back(std::move(trial));
  };
  for (int joint = 0; joint < joints; ++joint) {
    auto now = convention;
    const campaign::JointReading current = readingOf(now, joint);
    add({Kind::sign, joint, -1, -current.sign}, [](auto& reading) { reading.sign = -reading.sign; });
    if (joint > 0) {
      const int plus = current.plus == joint - 1 ? -1 : joint - 1;
      add({Kind::coupling, joint, plus, 0.0}, [plus](auto& reading) { reading.plus = plus; });
    }
    for (const double quarters : {1.0, -1.0, 2.0}) {
      const double offset = current.offset + quarters * std::numbers::pi / 2.0;
      add({Kind::offset, joint, -1, offset}, [offset](auto& reading) { reading.offset = offset; });
    }
  }
  for (const double factor : {1e3, 1e-3, 25.4, 1.0 / 25.4, 1e3 / 25.4, 25.4e-3})
    trials.push_back({{Kind::unit, 0, -1, factor}, convention, factor});
  return trials;
}

}  // namespace

std::optional<double> chordMisfit(const robot::Robot& robot, const std::vector<campaign::JointReading>& convention,
                                  const std::vector<PlacedReading>& readings, double scale) {
  const std::vector<ReflectorPlaces> places =
      placesOf(robot, campaign::JointConvention(convention, robot.joints()), readings);
  if (places.empty()) return std::nullopt;
  return misfitOf(places, scale);
}

std::vector<OtherMeaning> otherMeanings(const robot::Robot& robot,
                                        const std::vector<campaign::JointReading>& convention,
                                        const std::vector<PlacedReading>& readings) {
  std::vector<OtherMeaning> meanings;
  for (const Trial& trial : trialsOf(convention, robot.joints())) {
    const auto misfit = chordMisfit(robot, trial.convention, readings, trial.scale);
    if (!misfit) return {};
    meanings.push_back(trial.meaning);
    meanings.back().misfit = *misfit;
  }
  std::stable_sort(meanings.begin(), meanings.end(),
                   [](const OtherMeaning& a, const OtherMeaning& b) { return a.misfit < b.misfit; });
  // What is a micrometre off is right, whatever the fit of the reflector leaves.
  constexpr double kAsWell = 2.0, kRight = 1e-6;
  const double most = std::max(kAsWell * meanings.front().misfit, kRight);
  std::erase_if(meanings, [most](const OtherMeaning& one) { return one.misfit > most; });
  return meanings;
}

namespace {

/// What would have to be written in DAY.xml.
std::string shownMeaning(const OtherMeaning& meaning) {
  using Kind = OtherMeaning::Kind;
  const int joint = meaning.joint + 1;
  switch (meaning.kind) {
    case Kind::unit:
      return fmt::format("points times {:g}", meaning.value);
    case Kind::sign:
      return fmt::format("joint_reading joint=\"{}\" sign=\"{:g}\"", joint, meaning.value);
    case Kind::offset:
      return fmt::format("joint_reading joint=\"{}\" offset_deg=\"{:g}\"", joint, meaning.value / io::kDegree);
    case Kind::coupling:
      break;
  }
  return meaning.plus < 0 ? fmt::format("joint_reading joint=\"{}\" without plus", joint)
                          : fmt::format("joint_reading joint=\"{}\" plus=\"{}\"", joint, meaning.plus + 1);
}

}  // namespace

void requireMeaning(const JoinTask& task, const std::vector<PlacedReading>& placed, double misfit) {
  if (misfit < kAsArmsDiffer) return;
  const auto others = otherMeanings(task.robot, task.day.xml.campaign.joint_readings, placed);
  if (others.empty() || kExplains * others.front().misfit > misfit) return;
  std::vector<std::string> shown;
  for (const OtherMeaning& other : others) shown.push_back(shownMeaning(other));
  throw io::InputError(
      {task.day.file, task.source.line, "log"}, task.source.file,
      fmt::format("expected joints that move the reflectors as they were read; distances between their places are "
                  "off by {:.1f} mm, with {} by {:.1f} mm",
                  misfit * 1e3, fmt::join(shown, " or "), others.front().misfit * 1e3));
}

}  // namespace stiffscope::interchange
