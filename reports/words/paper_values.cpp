#include "reports/words/paper_values.h"

namespace stiffscope::reports {

namespace {

using Joints2To6 = std::array<PaperStiffness, 5>;

constexpr std::array<Joints2To6, 3> kInactive{{
    {{{3.2, 0.58}, {1.5, 0.43}, {0.24, 2.7}, {0.21, 0.026}, {0.051, 0.012}}},
    {{{3.4, 0.067}, {2.2, 0.06}, {0.89, 0.21}, {6.9, 22}, {0.11, 0.028}}},
    {{{3.2, 0.039}, {2.6, 0.04}, {0.42, 0.057}, {0.23, 0.008}, {0.089, 0.018}}},
}};

constexpr std::array<Joints2To6, 3> kActive{{
    {{{7.4, 8.5}, {2.1, 1.7}, {-0.24, 0.22}, {0.37, 0.12}, {0.44, 0.007}}},
    {{{6.5, 0.27}, {4, 0.25}, {1, 0.3}, {2.7, 2300}, {0.087, 0.014}}},
    {{{5.6, 0.1}, {6.3, 0.22}, {0.46, 0.057}, {0.35, 0.012}, {0.079, 0.012}}},
}};

}  // namespace

std::optional<PaperStiffness> paperStiffness(const campaign::Campaign& campaign, identification::Method method,
                                             int joint) {
  constexpr int kPapersJoints = 6;
  const campaign::DoubleEncoder state = campaign.double_encoder;
  if (campaign.robot.joints() != kPapersJoints) return std::nullopt;
  if (state == campaign::DoubleEncoder::unspecified || joint < 1 || joint > 5) return std::nullopt;
  const auto& table = state == campaign::DoubleEncoder::active ? kActive : kInactive;
  return table[static_cast<std::size_t>(method)][static_cast<std::size_t>(joint) - 1];
}

}  // namespace stiffscope::reports
