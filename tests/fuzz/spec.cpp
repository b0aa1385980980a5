#include "core/simulation/read_spec.h"
#include "tests/fuzz/expect_input_error.h"

// The URDF that the specifications of the corpus name is a sample.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace stiffscope;
  fuzz::expectInputError(
      [&] { simulation::parseSimulationSpec(fuzz::textOf(data, size), STIFFSCOPE_SOURCE_DIR "/samples/spec.xml"); });
  return 0;
}
