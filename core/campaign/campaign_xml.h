#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/campaign/campaign.h"
#include "core/campaign/stated_balancer.h"
#include "core/io/xml.h"

namespace stiffscope::campaign {

/// A file that campaign.xml names, and where.
struct FileReference {
  std::string name;  ///< as written
  std::string attribute;
  std::size_t line = 0;
};

struct TableReference {
  FileReference file;
  PointFrame frame = PointFrame::tracker;
};

/// A joint that an attribute names, and where: how many there are is known when the URDF has been read.
struct JointNumber {
  int joint = 0;  ///< from 0
  std::string file;
  std::size_t line = 0;
  std::string attribute, value;
};

/// What campaign.xml itself says: `campaign` without its robot and tables, and the files that hold those.
struct CampaignXml {
  Campaign campaign;
  FileReference urdf;
  std::map<std::string, TableReference> tables;  ///< by element name
  std::size_t load_cell_line = 0;
  std::vector<JointNumber> joint_numbers;
  std::vector<StatedBalancer> balancers;
};

/// `double_encoder_joints` of an element `robot`, rising; none where it has no such attribute. Throws InputError for
/// what is not a list of different joints' numbers.
std::vector<JointNumber> readDoubleEncoderJoints(const io::XmlNode& robot);

/// Throws InputError for the first that names a joint which a machine of so many has not.
void requireJoints(const std::vector<JointNumber>& numbers, int joints);

/// Elements of campaign.xml that name a table, in the order of the format.
const std::vector<std::string>& tableElements();

/// Reads the bytes of a campaign.xml (format 1); `file` is its name for messages. What the format does not
/// know is ignored with a warning. Throws InputError with line and attribute for everything the format does
/// not allow; whether links and files exist is not looked at here.
CampaignXml readCampaignXml(const std::string& file, std::string_view bytes, std::vector<std::string>& warnings);

/// The same elements under another root, for files that describe a day before it is a campaign: name, date and all
/// sections but the tables. Elements and attributes of the root in `also` are the caller's to read.
CampaignXml readCampaignElements(const io::XmlNode& root, const std::vector<std::string>& also,
                                 std::vector<std::string>& warnings);

}  // namespace stiffscope::campaign
