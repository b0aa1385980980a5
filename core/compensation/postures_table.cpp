#include "core/compensation/postures_table.h"

#include "core/campaign/read_table.h"
#include "core/input/read_file.h"

namespace stiffscope {

namespace {

struct PostureRow {
  std::string id;
  Vector6d q = Vector6d::Zero();
  Vector6d wrench_in_cell = Vector6d::Zero();
  std::size_t line = 0;
};

const TableLayout<PostureRow>& posturesLayout() {
  using Row = PostureRow;
  static const TableLayout<Row> layout{
      "postures",
      joined<Row>({{{"pose", CellKind::text, [](Row& row) -> std::string& { return row.id; }}},
                   jointColumns<Row>(),
                   wrenchColumns<Row>()}),
      {"pose"}};
  return layout;
}

}  // namespace

std::vector<PostureToCompensate> readPostures(const std::filesystem::path& file, std::vector<std::string>& warnings) {
  const std::string bytes = readTextFile(file);
  CampaignNames names;
  std::vector<PostureToCompensate> postures;
  for (PostureRow& row : readTable<PostureRow>({file.string(), bytes}, posturesLayout(), names, warnings)) {
    postures.push_back({std::move(row.id), row.q, row.wrench_in_cell});
  }
  return postures;
}

std::vector<PostureToCompensate> campaignPostures(const Campaign& campaign, int step) {
  std::vector<PostureToCompensate> postures;
  for (const State& state : campaign.states->rows) {
    if (state.step != step) continue;
    postures.push_back({campaign.pose_ids[static_cast<std::size_t>(state.pose)], state.q, state.wrench_in_cell});
  }
  return postures;
}

}  // namespace stiffscope
