#include "bench/large_campaign.h"

#include <cstdio>
#include <fstream>
#include <memory>
#include <random>
#include <string>

namespace stiffscope::bench {

namespace {

constexpr int kSteps = 15;
const char* const kTargets[] = {"P10", "P11", "P12"};

/// A table that is written line by line, so that the benchmark itself stays small in memory.
class TableFile {
 public:
  TableFile(const std::filesystem::path& file, const char* header)
      : file_(std::fopen(file.c_str(), "wb"), std::fclose) {
    std::fprintf(file_.get(), "%s\n", header);
  }

  template <class... Values>
  void line(const char* format, const Values&... values) {
    std::fprintf(file_.get(), format, values...);
  }

  void point(double x, double y, double z) { line("%.4f,%.4f,%.4f", x + drawn(), y + drawn(), z + drawn()); }
  void joints() { line("%.5f,%.5f,%.5f,%.5f,%.5f,%.5f", drawn(), drawn(), drawn(), drawn(), drawn(), drawn()); }
  double drawn() { return uniform_(random_); }

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  std::mt19937_64 random_{1};
  std::uniform_real_distribution<double> uniform_{-100.0, 100.0};
};

void writeXml(const std::filesystem::path& folder, const std::string& tables) {
  std::filesystem::create_directories(folder);
  std::filesystem::copy_file(STIFFSCOPE_SOURCE_DIR "/samples/inactive/robot.urdf", folder / "robot.urdf",
                             std::filesystem::copy_options::overwrite_existing);
  std::ofstream xml(folder / "campaign.xml");
  xml << "<campaign format=\"1\" name=\"large\" date=\"2026-01-01\">\n"
         "<robot urdf=\"robot.urdf\" base_link=\"base_link\" flange_link=\"tool0\" double_encoder=\"inactive\"/>\n"
         "<targets>";
  for (const char* id : kTargets) xml << "<target id=\"" << id << "\"/>";
  xml << "</targets>\n"
         "<load_cell parent=\"tool0\" xyz_mm=\"0 0 0\" rpy_deg=\"0 0 0\" force_sigma_n=\"1\" moment_sigma_nm=\"1\"/>\n"
      << tables << "</campaign>\n";
}

}  // namespace

void writeManyPostures(const std::filesystem::path& folder, int postures) {
  writeXml(folder, "<loading file=\"loading.csv\"/><states file=\"states.csv\"/>");
  TableFile loading(folder / "loading.csv", "pose,step,repeat,target,time_s,x_mm,y_mm,z_mm");
  TableFile states(folder / "states.csv",
                   "pose,step,time_s,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg,fx_n,fy_n,fz_n,mx_nm,my_nm,mz_nm");
  for (int pose = 1; pose <= postures; ++pose) {
    for (int step = 0; step < kSteps; ++step) {
      const double time = 30.0 * pose + 2.0 * step;
      states.line("p%d,%d,%.1f,", pose, step, time);
      states.joints();
      states.line(",%.3f,%.3f,%.3f,%.4f,%.4f,%.4f\n", states.drawn(), states.drawn(), states.drawn(), states.drawn(),
                  states.drawn(), states.drawn());
      for (const char* target : kTargets) {
        loading.line("p%d,%d,1,%s,%.1f,", pose, step, target, time);
        loading.point(2136.9, 156.1, 412.2);
        loading.line("\n");
      }
    }
  }
}

void writeLongWristSweep(const std::filesystem::path& folder, int readings) {
  writeXml(folder, "<wrist_sweep file=\"wrist_sweep.csv\"/>");
  TableFile sweep(folder / "wrist_sweep.csv",
                  "index,target,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg,x_mm,y_mm,z_mm,time_s");
  for (int i = 0; i < readings; ++i) {
    sweep.line("%d,P10,0,0,0,%.5f,%.5f,%.5f,", i, sweep.drawn(), sweep.drawn(), sweep.drawn());
    sweep.point(2326.7, 632.0, 952.2);
    sweep.line(",%.1f\n", 0.1 * i);
  }
}

}  // namespace stiffscope::bench
