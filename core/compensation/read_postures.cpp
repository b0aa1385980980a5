#include "core/campaign/joint_reading.h"
#include "core/campaign/read_table.h"
#include "core/compensation/compensate.h"
#include "core/io/read_file.h"

namespace stiffscope::compensation {

namespace {

struct PostureRow {
  std::string id;
  JointVector q;
  Vector6d wrench_in_cell = Vector6d::Zero();
  std::size_t line = 0;
};

campaign::TableLayout<PostureRow> posturesLayout(int joints) {
  using Row = PostureRow;
  return {"postures",
          campaign::joined<Row>({{{"pose", campaign::CellKind::text, [](Row& row) -> std::string& { return row.id; }}},
                                 campaign::jointColumns<Row>(joints),
                                 campaign::wrenchColumns<Row>()}),
          {"pose"},
          campaign::blankRow<Row>(joints)};
}

}  // namespace

std::vector<PostureToCompensate> withAnglesOfFigures(std::vector<PostureToCompensate> postures,
                                                     const campaign::Campaign& campaign) {
  const campaign::JointConvention convention(campaign.joint_readings, campaign.robot.joints());
  for (PostureToCompensate& posture : postures) posture.q = convention.angles(posture.q);
  return postures;
}

std::vector<PostureToCompensate> readPostures(const std::filesystem::path& file, const campaign::Campaign& campaign,
                                              std::vector<std::string>& warnings) {
  const int joints = campaign.robot.joints();
  const std::string bytes = io::readTextFile(file);
  campaign::CampaignNames names;
  std::vector<PostureToCompensate> postures;
  for (PostureRow& row :
       campaign::readTable<PostureRow>({file.string(), bytes}, posturesLayout(joints), names, warnings)) {
    postures.push_back({std::move(row.id), row.q, row.wrench_in_cell});
  }
  return withAnglesOfFigures(std::move(postures), campaign);
}

std::vector<NamedReading> readWrenches(const std::filesystem::path& file, std::vector<std::string>& warnings) {
  using Row = NamedReading;
  static const campaign::TableLayout<Row> layout{
      "wrenches",
      campaign::joined<Row>({{{"pose", campaign::CellKind::text, [](Row& row) -> std::string& { return row.id; }}},
                             campaign::wrenchColumns<Row>()}),
      {"pose"}};
  const std::string bytes = io::readTextFile(file);
  campaign::CampaignNames names;
  return campaign::readTable<Row>({file.string(), bytes}, layout, names, warnings);
}

std::vector<PostureToCompensate> campaignPostures(const campaign::Campaign& campaign, int step) {
  std::vector<PostureToCompensate> postures;
  for (const campaign::State& state : campaign.states->rows) {
    if (state.step != step) continue;
    postures.push_back({campaign.pose_ids[static_cast<std::size_t>(state.pose)], state.q, state.wrench_in_cell});
  }
  return postures;
}

}  // namespace stiffscope::compensation
