#include "core/campaign/campaign_xml.h"

#include "tests/fuzz/expect_input_error.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace stiffscope;
  fuzz::expectInputError([&] {
    std::vector<std::string> warnings;
    campaign::readCampaignXml("campaign.xml", fuzz::textOf(data, size), warnings);
  });
  return 0;
}
