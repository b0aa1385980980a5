#include "core/campaign/circle_sweeps_table.h"
#include "core/campaign/displacements_table.h"
#include "core/campaign/loading_table.h"
#include "core/campaign/nests_table.h"
#include "core/campaign/read_table.h"
#include "core/campaign/states_table.h"
#include "core/campaign/wrist_sweep_table.h"
#include "tests/fuzz/expect_input_error.h"

namespace {

using namespace stiffscope;

template <class Row>
void readAs(const TableLayout<Row>& layout, std::string_view bytes) {
  std::vector<std::string> warnings;
  CampaignNames names;
  names.targets.add("P10");
  names.targets.add("P11");
  readTable<Row>({layout.element + ".csv", bytes}, layout, names, warnings);
}

void readAsTable(char kind, std::string_view bytes) {
  switch (kind) {
    case 'c': return readAs(circleSweepsLayout(), bytes);
    case 'w': return readAs(wristSweepLayout(), bytes);
    case 'l': return readAs(loadingLayout(), bytes);
    case 's': return readAs(statesLayout(), bytes);
    case 'd': return readAs(displacementsLayout(), bytes);
    default: return readAs(nestsLayout(), bytes);
  }
}

}  // namespace

// The first byte says which table it is.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  fuzz::expectInputError([&] { readAsTable(static_cast<char>(data[0]), fuzz::textOf(data + 1, size - 1)); });
  return 0;
}
