#include "app/urdf.h"

#include "core/calibration/calibrated_urdf.h"
#include "core/io/read_file.h"
#include "core/io/write_file.h"

namespace stiffscope::app {

// Reading a campaign records campaign.xml, then the URDF, then the tables.
std::filesystem::path urdfOf(const campaign::Campaign& campaign) {
  return campaign.folder / campaign.inputs.at(1).name;
}

std::string urdfBytes(const campaign::Campaign& campaign) {
  return io::readTextFile(urdfOf(campaign), io::kLargestXml);
}

void writeCalibratedUrdf(const campaign::Campaign& campaign, const robot::Robot& arm, const std::string& file) {
  const std::string bytes = urdfBytes(campaign);
  io::requireNotRead(file);
  io::writeFileWhole(file, calibration::calibratedUrdf(bytes, urdfOf(campaign).string(), campaign.base_link,
                                                       campaign.flange_link, campaign.robot, arm));
}

}  // namespace stiffscope::app
