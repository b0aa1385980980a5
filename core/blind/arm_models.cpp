#include "core/blind/arm_models.h"

#include <fmt/format.h>

#include <utility>

namespace stiffscope::blind {

const std::array<ArmModel, 4> kArmModels{{
    // FANUC M-900iB/700, 700 kg, 2.83 m
    {"m900ib700",
     "heavy",
     0.94,
     0.41,
     1.12,
     0.25,
     1.285,
     0.30,
     {1, 1, 1, 1, 1, 1},
     {1000, 550, 650, 160, 60, 15},
     {7e6, 4.5e6, 4.5e6, 4.6e5, 3.5e5, 1.2e5},
     {1200, 2400},
     45},
    // KUKA KR 210 R2700 extra, 210 kg, 2.70 m
    {"kr210r2700",
     "large",
     0.675,
     0.35,
     1.15,
     -0.041,
     1.20,
     0.215,
     {-1, 1, -1, 1, -1, 1},
     {330, 260, 220, 90, 40, 10},
     {3.0e6, 2.8e6, 2.0e6, 3.5e5, 2.5e5, 0.9e5},
     {900, 1700},
     25},
    // ABB IRB 4600-60/2.05, 60 kg, 2.05 m
    {"irb4600_60",
     "medium",
     0.495,
     0.175,
     0.90,
     0.175,
     0.96,
     0.135,
     {1, 1, -1, -1, -1, -1},
     {140, 90, 85, 35, 12, 3},
     {1.2e6, 1.0e6, 7e5, 8e4, 6e4, 3e4},
     {300, 550},
     10},
    // FANUC M-20iA, 20 kg, 1.81 m
    {"m20ia",
     "small",
     0.525,
     0.15,
     0.79,
     0.25,
     0.835,
     0.10,
     {1, 1, 1, 1, 1, 1},
     {85, 45, 45, 18, 7, 1.5},
     {3.0e5, 2.5e5, 2.0e5, 2.5e4, 1.8e4, 0.9e4},
     {110, 190},
     4},
}};

namespace {

struct Part {
  double x, z;                   ///< of the joint in the link before it
  const char* axis[2];           ///< of positive and negative sense
  double com_x, com_z;           ///< of the body in its own link
  std::array<double, 2> limits;  ///< rad, for positive sense
};

std::string linkXml(int index, double mass, const Part& part) {
  return fmt::format(
      "  <link name=\"link_{}\"><inertial><origin xyz=\"{:.6g} 0 {:.6g}\"/><mass value=\"{:.6g}\"/>"
      "<inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link>\n",
      index, part.com_x, part.com_z, mass);
}

std::string jointXml(int index, int sense, const Part& part) {
  std::array<double, 2> limits = part.limits;
  if (sense < 0) limits = {-part.limits[1], -part.limits[0]};
  return fmt::format(
      "  <joint name=\"joint_{0}\" type=\"revolute\">\n    <parent link=\"{1}\"/><child link=\"link_{0}\"/>\n"
      "    <origin xyz=\"{2:.6g} 0 {3:.6g}\" rpy=\"0 0 0\"/><axis xyz=\"{4}\"/>\n"
      "    <limit lower=\"{5}\" upper=\"{6}\" effort=\"0\" velocity=\"0\"/>\n  </joint>\n",
      index, index == 1 ? "base_link" : fmt::format("link_{}", index - 1), part.x, part.z,
      part.axis[sense > 0 ? 0 : 1], limits[0], limits[1]);
}

}  // namespace

std::string armUrdf(const ArmModel& m) {
  constexpr const char *kX = "1 0 0", *kMinusX = "-1 0 0", *kY = "0 1 0", *kMinusY = "0 -1 0";
  const std::array<Part, 6> parts{{{0, m.d1, {"0 0 1", "0 0 -1"}, 0.37 * m.a1, -0.2 * m.d1, {-3.1, 3.1}},
                                   {m.a1, 0, {kY, kMinusY}, 0, 0.45 * m.a2, {-1.1, 1.5}},
                                   {0, m.a2, {kMinusY, kY}, -0.08 * m.d4, 0.6 * m.a3, {-2.2, 0.9}},
                                   {0, m.a3, {kMinusX, kX}, 0.55 * m.d4, 0, {-3.1, 3.1}},
                                   {m.d4, 0, {kMinusY, kY}, 0.17 * m.d6, 0, {-2.1, 2.1}},
                                   {m.d6, 0, {kMinusX, kX}, 0, 0, {-3.1, 3.1}}}};
  std::string text =
      fmt::format("<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n  <link name=\"base_link\"/>\n", m.name);
  for (std::size_t i = 0; i < 6; ++i) text += linkXml(static_cast<int>(i) + 1, m.masses_kg[i], parts[i]);
  text += "  <link name=\"tool0\"/>\n";
  for (std::size_t i = 0; i < 6; ++i) text += jointXml(static_cast<int>(i) + 1, m.sense[i], parts[i]);
  return text +
         "  <joint name=\"flange\" type=\"fixed\"><parent link=\"link_6\"/><child link=\"tool0\"/>"
         "<origin xyz=\"0 0 0\" rpy=\"3.141592653589793 -1.5707963267948966 0\"/></joint>\n</robot>\n";
}

}  // namespace stiffscope::blind
