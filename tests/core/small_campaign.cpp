#include "tests/core/small_campaign.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <sstream>

namespace stiffscope {

namespace {

const char* const kXml = R"(<?xml version="1.0" encoding="UTF-8"?>
<campaign format="1" name="small" date="2026-01-02">
  <laboratory>Force &amp; Motion</laboratory>
  <customer>C</customer>
  <operator>O</operator>
  <item>I</item>
  <conditions>20 degC</conditions>
  <robot urdf="robot.urdf" base_link="base" flange_link="flange" double_encoder="active"/>
  <tracker model="T" range_fixed_um="4" range_per_m_um="0.6" angle_fixed_um="6" angle_per_m_um="2.2"/>
  <targets>
    <target id="P10" x_mm="1" y_mm="2" z_mm="300"/>
    <target id="P11"/>
  </targets>
  <load_cell parent="flange" xyz_mm="0 0 90" rpy_deg="0 0 90" force_sigma_n="1" moment_sigma_nm="0.3"/>
  <tool mass_kg="45" com_mm="0 0 100"/>
  <circle_sweeps file="circle_sweeps.csv"/>
  <wrist_sweep file="wrist_sweep.csv"/>
  <loading file="loading.csv"/>
  <states file="states.csv"/>
  <displacements file="displacements.csv" frame="base_link"/>
  <nests file="nests.csv"/>
</campaign>
)";

const char* const kCircleSweeps =
    R"(axis,index,target,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg,x_mm,y_mm,z_mm
1,0,P10,-54.5,0,0,0,0,0,1381.5576,2431.6095,1212.3082
1,0,P11,-54.5,0,0,0,0,0,1392.9405,2561.0824,927.1266
6,1,P10,0,0,0,0,0,90,1384.4022,2260.8383,1209.5726
)";

const char* const kWristSweep =
    R"(index,target,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg,x_mm,y_mm,z_mm,time_s
0,P10,0,0,0,-116.85697,4.70712,-129.16889,2326.7124,632.0033,952.1996,5.5
)";

const char* const kLoading = R"(pose,step,repeat,target,time_s,x_mm,y_mm,z_mm
A,0,1,P10,1078.0,2136.9015,156.1428,412.2275
A,1,1,P10,1080.0,2136.9015,156.1428,411.2275
A,1,2,P10,1081.0,2136.9015,156.1428,411.2280
)";

const char* const kStates =
    R"(pose,step,time_s,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg,fx_n,fy_n,fz_n,mx_nm,my_nm,mz_nm
A,0,1076.0,7.93121,26.73967,3.67551,-72.14435,26.25065,104.19286,-0.312,-0.039,0.265,-0.515,0.315,-0.441
A,1,1170.3,7.93121,26.73967,3.67551,-72.14435,26.25065,104.19286,-538.428,-229.767,140.784,39.656,-100.265,-11.28
B,1,1170.4,7.93121,26.73967,3.67551,-72.14435,26.25065,104.19286,-538.428,-229.767,140.784,39.656,-100.265,-11.28
)";

const char* const kDisplacements = R"(pose,step,target,dx_mm,dy_mm,dz_mm
B,1,P10,-0.686,-0.396,-0.025
)";

const char* const kNests = R"(time_s,nest,x_mm,y_mm,z_mm
0.0,N1,3349.2176,-241.6309,-1209.9495
2.0,N2,894.7970,1315.5592,-1180.4804
)";

std::string joint(int number, const char* parent, const char* axis) {
  const std::string n = std::to_string(number);
  return "  <joint name=\"joint_" + n + "\" type=\"revolute\"><parent link=\"" + parent +
         "\"/><child link=\"link_" + n + "\"/>" + "<origin xyz=\"0." + n +
         " 0 0.5\" rpy=\"0 0 0\"/><axis xyz=\"" + axis + "\"/><limit lower=\"-3\" upper=\"3\"/></joint>\n";
}

std::string urdf() {
  std::string text = "<?xml version=\"1.0\"?>\n<robot name=\"small\">\n  <link name=\"base\"/>\n";
  for (const char* n : {"1", "2", "3", "4", "5", "6"}) {
    text += "  <link name=\"link_" + std::string(n) + "\"><inertial><origin xyz=\"0 0 0.1\"/><mass value=\"" +
            n + "0\"/></inertial></link>\n";
  }
  text += "  <link name=\"flange\"/>\n";
  text += joint(1, "base", "0 0 1") + joint(2, "link_1", "0 2 0") + joint(3, "link_2", "0 1 0");
  text += joint(4, "link_3", "1 0 0") + joint(5, "link_4", "0 1 0") + joint(6, "link_5", "1 0 0");
  return text +
         "  <joint name=\"to_flange\" type=\"fixed\"><parent link=\"link_6\"/><child "
         "link=\"flange\"/></joint>\n"
         "</robot>\n";
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "stiffscope-test-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder: " + name);
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

SmallCampaign::SmallCampaign() {
  write("campaign.xml", kXml);
  write("robot.urdf", urdf());
  write("circle_sweeps.csv", kCircleSweeps);
  write("wrist_sweep.csv", kWristSweep);
  write("loading.csv", kLoading);
  write("states.csv", kStates);
  write("displacements.csv", kDisplacements);
  write("nests.csv", kNests);
}

void SmallCampaign::write(const std::string& file, const std::string& bytes) const {
  std::ofstream(folder() / file, std::ios::binary) << bytes;
}

std::string SmallCampaign::read(const std::string& file) const {
  std::ostringstream bytes;
  bytes << std::ifstream(folder() / file, std::ios::binary).rdbuf();
  return bytes.str();
}

void SmallCampaign::remove(const std::string& file) const { std::filesystem::remove(folder() / file); }

void SmallCampaign::alter(const std::string& file, const std::string& find,
                          const std::string& replace) const {
  std::string bytes = read(file);
  const std::size_t at = bytes.find(find);
  ASSERT_NE(at, std::string::npos) << file << " has no " << find;
  write(file, bytes.replace(at, find.size(), replace));
}

}  // namespace stiffscope
