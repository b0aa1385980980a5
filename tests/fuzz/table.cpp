#include <cctype>

#include "core/campaign/read_table.h"
#include "core/campaign/table_layouts.h"
#include "tests/fuzz/expect_input_error.h"

namespace {

using namespace stiffscope;

template <class Row>
void readAs(const campaign::TableLayout<Row>& layout, std::string_view bytes, int joints = 6) {
  std::vector<std::string> warnings;
  campaign::CampaignNames names;
  names.targets.add("P10");
  names.targets.add("P11");
  names.axes = joints;
  campaign::readTable<Row>({layout.element + ".csv", bytes}, layout, names, warnings);
}

/// A capital letter: of a machine of seven joints; else of six.
void readAsTable(char kind, std::string_view bytes) {
  const int joints = std::isupper(static_cast<unsigned char>(kind)) != 0 ? 7 : 6;
  switch (std::tolower(static_cast<unsigned char>(kind))) {
    case 'c':
      return readAs(campaign::circleSweepsLayout(joints), bytes, joints);
    case 'w':
      return readAs(campaign::wristSweepLayout(joints), bytes);
    case 'l':
      return readAs(campaign::loadingLayout(), bytes);
    case 's':
      return readAs(campaign::statesLayout(joints), bytes);
    case 'r':
      return readAs(campaign::railSweepLayout(), bytes);
    case 'd':
      return readAs(campaign::displacementsLayout(), bytes);
    default:
      return readAs(campaign::nestsLayout(), bytes);
  }
}

}  // namespace

// The first byte says which table it is.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  fuzz::expectInputError([&] { readAsTable(static_cast<char>(data[0]), fuzz::textOf(data + 1, size - 1)); });
  return 0;
}
