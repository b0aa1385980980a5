#include <gtest/gtest.h>

#include "core/campaign/campaign.h"
#include "core/diagnosis/diagnosis.h"
#include "core/diagnosis/spike_study.h"
#include "reports/json/json.h"
#include "reports/json/json_document.h"
#include "reports/text/text.h"

namespace stiffscope {
namespace spike_report_test {

diagnosis::SpikeStudy smallStudy() {
  diagnosis::SpikeCounts small, large;
  small.times = 1.0, small.size = 12e-6, small.draws = 8, small.named = 3, small.part_named = 2;
  small.class_size = 1.5, small.other_named = 2, small.others = {{effects::Effect::backlash, 2}};
  large.times = 4.0, large.size = 48e-6, large.draws = 7, large.named = 7, large.part_named = 7;
  large.class_size = 1.0, large.unknown = 1;
  diagnosis::SpikedEffect seen{effects::Effect::hysteresis, 12e-6, {}, true, {small, large}};
  diagnosis::SpikedEffect hidden{
      effects::Effect::tracker_drift, std::nullopt, Remark(diagnosis::RemarkId::spike_hidden), false, {}};
  return {{seen, hidden}, 5, 8};
}

diagnosis::Diagnosis baseline() {
  diagnosis::Diagnosis diagnosis(6);
  diagnosis.usable = true;
  diagnosis.verdict.entries = {{{effects::Effect::hysteresis}, "joint 2"}};
  return diagnosis;
}

TEST(SpikeReport, jsonHasCountsAndBaseline) {
  const campaign::Campaign campaign;
  const reports::Json json = reports::withSpikes(reports::diagnosisJson(campaign, baseline()), smallStudy());
  const reports::Json& spike = json["spike"];
  EXPECT_EQ(spike["seed"], 5);
  EXPECT_EQ(spike["baseline"], json["verdict"]);
  EXPECT_EQ(spike["baseline"][0][0], "hysteresis");
  ASSERT_EQ(spike["effects"].size(), 2u);
  EXPECT_EQ(spike["effects"][0]["in_baseline"], true);
  EXPECT_NEAR(spike["effects"][0]["sizes"][1]["size_um"].get<double>(), 48.0, 1e-9);
  EXPECT_EQ(spike["effects"][0]["sizes"][0]["named"], 3);
  EXPECT_EQ(spike["effects"][0]["sizes"][0]["others"]["backlash"], 2);
  EXPECT_TRUE(spike["effects"][1]["detectable_um"].is_null());
  EXPECT_FALSE(spike["effects"][1]["reason"].get<std::string>().empty());
}

TEST(SpikeReport, textHasARowAnEffect) {
  const std::string text = reports::spikeText(baseline(), smallStudy());
  for (const char* part : {"hysteresis *", "3/8", "7/7", "9/10", "2/15", "besides: backlash 2, unknown 1", "Without",
                           "hysteresis (joint 2)", "tracker drift", "not added"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t to = std::min(text.find('\n', from), text.size());
    EXPECT_LE(to - from, 100u) << text.substr(from, to - from);
    from = to + 1;
  }
}

}  // namespace spike_report_test
}  // namespace stiffscope
