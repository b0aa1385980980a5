// Text and JSON of a calibration by a day without a load.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "core/calibration/calibrate.h"
#include "core/calibration/denavit_hartenberg.h"
#include "reports/json/json.h"
#include "reports/text/text.h"
#include "reports/words/calibration_words.h"
#include "tests/fixtures/unloaded_day.h"

namespace stiffscope {
namespace calibration_report_test {

constexpr int kPostures = 80;
constexpr double kFirstTime = 600.0;  // s

/// A day whose links are longer by a share of the posture; the shortest of them is 0.25 m.
struct CalibratedDay {
  UnloadedSpec spec;
  campaign::Campaign campaign;
  calibration::Calibration calibration;

  explicit CalibratedDay(const std::function<double(int)>& longer, const std::function<double(int)>& temperature_c) {
    Noise noise(91);
    spec.built = spec.nominal.disturbed(noise, 0.2e-3, 0.1e-3);
    spec.postures = kPostures;
    spec.noise = 3e-6;  // a link's length is then known to some micrometres
    spec.temperature_c = temperature_c;
    spec.arm_at = [longer](const ChainArm& built, int posture) { return grown(built, longer(posture)); };
    campaign = unloadedCampaign(spec, noise);
    for (campaign::State& state : campaign.states->rows) state.time_s += kFirstTime;
    calibration = calibration::calibrate(campaign, {});
  }

  /// From axis to axis: where the first stands is the base's place.
  static ChainArm grown(ChainArm arm, double share) {
    for (std::size_t j = 1; j < arm.to_joint.size(); ++j) arm.to_joint[j].translation() *= 1.0 + share;
    return arm;
  }

  reports::Json json() const { return reports::calibrationJson(campaign, calibration, {}); }
  /// Without the breaks of its lines.
  std::string text() const {
    std::string words;
    for (const char one : reports::calibrationText(campaign, calibration, {})) {
      const bool blank = one == ' ' || one == '\n';
      if (!blank || (!words.empty() && words.back() != ' ')) words += blank ? ' ' : one;
    }
    return words;
  }
  /// The upper arm, from axis 2 to axis 3, which are parallel: by the axes with effects, and of the arm as built.
  double length() const { return lengthOf(calibration.best().fit.arm(calibration.day.arm)); }
  double builtLength(double share) const { return lengthOf(grown(spec.built, share).robot()); }

 private:
  double lengthOf(const robot::Robot& arm) const {
    return calibration::denavitHartenberg(arm, calibration.day.arm).links[1].a;
  }
};

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

constexpr double kSteel = 12e-6;  // 1/K

double warmer(int posture) { return 4.0 - 4.0 * std::cos(posture / double(kPostures - 1) * 3.0 * std::numbers::pi); }

double meanWarmer() {
  double sum = 0.0;
  for (int i = 0; i < kPostures; ++i) sum += warmer(i);
  return sum / kPostures;
}

TEST(CalibrationReport, AxesWithGrowthByTemperatureSayOfWhichTemperatureTheyAre) {
  const CalibratedDay day([](int posture) { return kSteel * warmer(posture); },
                          [](int posture) { return 20.0 + warmer(posture); });
  const reports::Json json = day.json();
  ASSERT_TRUE(json.contains("axes_with_effects_at_temperature_c"));
  EXPECT_NEAR(json["axes_with_effects_at_temperature_c"].get<double>(), 20.0 + meanWarmer(), 1e-9);
  EXPECT_FALSE(json.contains("axes_with_effects_at_s"));
  const std::string said =
      fmt::format("Growth is counted from {:.1f} degrees C, the mean over the day's postures: ", 20.0 + meanWarmer());
  EXPECT_TRUE(has(day.text(), said)) << day.text();
  EXPECT_TRUE(has(day.text(), "are those of the arm at that temperature; "));
  // Some 50 um longer than at the 20 degrees of the first posture; told to a few.
  EXPECT_NEAR(day.length(), day.builtLength(kSteel * meanWarmer()), 15e-6);
  EXPECT_GT(std::abs(day.builtLength(kSteel * meanWarmer()) - day.builtLength(0.0)), 40e-6);
}

TEST(CalibrationReport, AxesWithGrowthByTimeAreThoseOfTheFirstPosture) {
  const CalibratedDay day([](int posture) { return 100e-6 * posture / (kPostures - 1); }, {});
  const reports::Json json = day.json();
  ASSERT_TRUE(json.contains("axes_with_effects_at_s"));
  EXPECT_EQ(json["axes_with_effects_at_s"].get<double>(), kFirstTime);
  EXPECT_FALSE(json.contains("axes_with_effects_at_temperature_c"));
  EXPECT_TRUE(has(day.text(), "Growth is counted from the first posture of the day: ")) << day.text();
  EXPECT_NEAR(day.length(), day.builtLength(0.0), 15e-6);
}

TEST(CalibrationReport, AnArmThatDoesNotGrowHasNoStateToBeSaid) {
  const CalibratedDay day([](int) { return 0.0; }, [](int posture) { return 20.0 + warmer(posture); });
  const reports::Json json = day.json();
  EXPECT_FALSE(json.contains("axes_with_effects_at_temperature_c"));
  EXPECT_FALSE(json.contains("axes_with_effects_at_s"));
  EXPECT_FALSE(has(day.text(), "Growth is counted"));
}

TEST(CalibrationReport, GrowthOfBothKindsIsSaidInOneSentence) {
  EXPECT_EQ(reports::growthFromWords({26.14, true}),
            "Growth is counted from 26.1 degrees C, the mean over the day's postures, and from the first of them: the "
            "axes fitted with the effects, and the lengths between them, are those of the arm at that temperature and "
            "time; the geometry alone is that of the day's average");
  EXPECT_EQ(reports::growthFromWords({}), "");
}

}  // namespace calibration_report_test
}  // namespace stiffscope
