#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "tests/app/command.h"

namespace stiffscope {
namespace command_line_test {

const std::string kActive = STIFFSCOPE_SOURCE_DIR "/samples/active";

TEST(CommandLine, HelpAndVersionSucceed) {
  const ScratchFolder scratch;
  for (const char* words : {"--help", "--version", "frames --help", "identify --help", "compensate --help",
                            "simulate --help", "report --help", "view --help", "view -h"}) {
    const Ran ran = runProgram(words, scratch.path());
    EXPECT_EQ(ran.status, 0) << words;
    EXPECT_FALSE(ran.out.empty()) << words;
  }
}

TEST(CommandLine, HelpOfACommandIsWhatItsOwnOptionPrints) {
  const ScratchFolder scratch;
  for (const char* command : {"audit", "import campaign"}) {
    const Ran asked = runProgram(std::string("help ") + command, scratch.path());
    EXPECT_EQ(asked.status, 0) << command;
    EXPECT_NE(asked.out.find(std::string("Usage: stiffscope ") + command), std::string::npos) << asked.out;
    EXPECT_EQ(asked.out, runProgram(std::string(command) + " --help", scratch.path()).out);
  }
}

// Neither a display nor stiffscope-view is needed for it.
TEST(CommandLine, HelpOfTheWindowNamesItsOptions) {
  const ScratchFolder scratch;
  const Ran ran = runProgram("view --help", scratch.path());
  EXPECT_EQ(ran.status, 0) << ran.err;
  for (const char* word : {"stiffscope view", "CAMPAIGN", "--magnification", "--screenshot"})
    EXPECT_NE(ran.out.find(word), std::string::npos) << word << "\n" << ran.out;
}

// One letter where a person looks and the letter exists; what programs read stays the same everywhere.
TEST(CommandLine, PlusMinusIsOneLetterOnATerminalOfUtf8) {
  if (std::system("command -v script >/dev/null") != 0) GTEST_SKIP() << "no script (bsdutils)";
  const ScratchFolder scratch;
  const auto onTerminal = [&](const std::string& locale) {
    const std::string out = (scratch.path() / "seen").string();
    const std::string line = "script -qec \"env " + locale + " '" STIFFSCOPE_BINARY "' frames '" + kActive +
                             "' --springs-only --color never\" /dev/null </dev/null >'" + out + "' 2>&1";
    EXPECT_EQ(std::system(line.c_str()), 0) << line;
    return contentsOf(out);
  };
  const std::string letter = "\u00b1";
  const std::string utf8 = onTerminal("LC_ALL=C.UTF-8"), ascii = onTerminal("LC_ALL=C LANG=C.UTF-8");
  EXPECT_NE(utf8.find(letter), std::string::npos) << utf8;
  EXPECT_EQ(utf8.find("+-"), std::string::npos) << utf8;
  EXPECT_NE(ascii.find("+-"), std::string::npos) << ascii;
  EXPECT_EQ(ascii.find(letter), std::string::npos) << ascii;
  const Ran piped = runProgram("frames '" + kActive + "' --springs-only", scratch.path());
  EXPECT_NE(piped.out.find("+-"), std::string::npos) << piped.out;
  EXPECT_EQ(piped.out.find(letter), std::string::npos) << piped.out;
}

TEST(CommandLine, QuietLeavesOutWarningsAndVerboseSaysTheTime) {
  const ScratchFolder scratch;
  std::filesystem::copy(kActive, scratch.path() / "day");
  std::string xml = contentsOf(scratch.path() / "day/campaign.xml");
  xml.replace(xml.find("<robot "), 7, "<robot colour=\"red\" ");
  std::ofstream(scratch.path() / "day/campaign.xml", std::ios::binary) << xml;
  std::ofstream(scratch.path() / "p.txt") << "0 0 0\n1 0 0\n0 1 0\n1 1 0.1\n";
  const std::string frames = "frames '" + (scratch.path() / "day").string() + "' --springs-only";
  const Ran usual = runProgram(frames, scratch.path()), quiet = runProgram(frames + " -q", scratch.path());
  const Ran verbose = runProgram(frames + " -v", scratch.path());
  EXPECT_NE(usual.err.find("colour: unknown attribute"), std::string::npos) << usual.err;
  EXPECT_EQ(usual.err.find("in all"), std::string::npos) << usual.err;
  EXPECT_EQ(quiet.err, "");
  EXPECT_NE(verbose.err.find("colour: unknown attribute"), std::string::npos) << verbose.err;
  EXPECT_TRUE(std::regex_search(verbose.err, std::regex("stiffscope: reading [^\n]*: [0-9.]+ s\n"))) << verbose.err;
  EXPECT_EQ(usual.out, quiet.out);
  EXPECT_EQ(usual.out, verbose.out);
  // A command without stages says how long it took.
  const Ran fit = runProgram("fit plane '" + (scratch.path() / "p.txt").string() + "' -v", scratch.path());
  EXPECT_TRUE(std::regex_match(fit.err, std::regex("stiffscope: fit: [0-9.]+ s in all\n"))) << fit.err;
}

TEST(CommandLine, AnOptionBeforeItsCommandIsToldItsPlace) {
  const ScratchFolder scratch;
  for (const std::string& words : std::vector<std::string>{
           "--json out.json identify '" + kActive + "'", "--json=out.json identify '" + kActive + "'",
           std::string("--method dpp identify x"), std::string("--raw")}) {
    const Ran ran = runProgram(words, scratch.path());
    EXPECT_EQ(ran.status, 2) << words;
    EXPECT_NE(ran.err.find("belongs after the command's name"), std::string::npos) << ran.err;
    EXPECT_EQ(ran.err.find("did you mean"), std::string::npos) << ran.err;
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
  }
}

TEST(CommandLine, WrongWordsGetTheNearestKnownOneAndStatusTwo) {
  const ScratchFolder scratch;
  const std::pair<const char*, const char*> cases[] = {
      {"identfy x", "did you mean 'identify'?"},
      {"identify x --stp 3", "did you mean '--step'?"},
      {"identify x --method dppp", "did you mean 'dpp'?"},
      {"identify", "CAMPAIGN"},
      {"identify nowhere", "expected a campaign folder"},
      {"compensate x --step all", "--step: 'all': expected the number of one load step"},
      {"identify x --step most", "--step: 'most': expected a load step's number, or all"},
      {"identify '" STIFFSCOPE_SOURCE_DIR "/samples/active/loading.csv'", "give the folder that holds this file"},
      {"fit plane x --strategy full", "--strategy: 'full': expected with circle only"},
  };
  for (const auto& [words, hint] : cases) {
    const Ran ran = runProgram(words, scratch.path());
    EXPECT_EQ(ran.status, 2) << words;
    EXPECT_NE(ran.err.find(hint), std::string::npos) << ran.err;
    EXPECT_EQ(std::count(ran.err.begin(), ran.err.end(), '\n'), 1) << ran.err;
  }
}

TEST(CommandLine, ViewIsTheWindowBesideIt) {
  const ScratchFolder scratch;
  if (!std::filesystem::exists(std::filesystem::path(STIFFSCOPE_BINARY).parent_path() / "stiffscope-view"))
    GTEST_SKIP() << "the window was not built";
  const Ran help = runProgram("view --help", scratch.path());
  EXPECT_EQ(help.status, 0);
  EXPECT_NE(help.out.find("Usage: stiffscope view [OPTIONS] CAMPAIGN"), std::string::npos) << help.out;
  const Ran wrong = runProgram("view '" + kActive + "' --metod dpp", scratch.path());
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.err.find("did you mean '--method'?"), std::string::npos) << wrong.err;
}

TEST(CommandLine, TheSameInputGivesTheSameBytes) {
  const ScratchFolder scratch;
  for (const std::string command : {"identify", "frames", "compensate"}) {
    const Ran first = runProgram(command + " '" + kActive + "' --json -", scratch.path());
    const Ran second = runProgram(command + " '" + kActive + "/campaign.xml' --json -", scratch.path());
    ASSERT_EQ(first.status, 0) << first.err;
    EXPECT_EQ(first.out, second.out) << command;
    EXPECT_TRUE(nlohmann::json::accept(first.out)) << command;
  }
}

TEST(CommandLine, JsonHasWhatTheContractPromises) {
  const ScratchFolder scratch;
  const auto identify = nlohmann::json::parse(runProgram("identify '" + kActive + "' --json -", scratch.path()).out);
  for (const char* method : {"cp", "pp", "dpp"}) {
    const auto& result = identify["methods"][method];
    EXPECT_TRUE(result["stiffness_nm_per_rad"][0].is_null()) << "the load only hangs";
    // Only scatter is known by few degrees of freedom; nothing else may state any.
    for (const auto& line : result["budget"]) {
      if (line["source"] == "scatter") continue;
      for (const auto& dof : line["dof"]) EXPECT_TRUE(dof.is_null()) << line;
    }
    EXPECT_GT(result["stiffness_nm_per_rad"][1].get<double>(), 1e6);
    EXPECT_TRUE(result["sd_nm_per_rad"][0].is_null());
    EXPECT_EQ(result["identifiable"], nlohmann::json({false, true, true, true, true, true}));
    for (const char* key : {"condition", "rms_residual_mm", "sigma_mm"}) EXPECT_TRUE(result[key].is_number()) << key;
    for (const char* place : {"compensated", "compensated_at_targets"}) {
      for (const char* key : {"used", "held_out", "sd_held_out", "all"})
        EXPECT_TRUE(result[place][key].is_number()) << place << key;
    }
  }
  const auto frames = nlohmann::json::parse(runProgram("frames '" + kActive + "' --json -", scratch.path()).out);
  EXPECT_EQ(frames["r0_from_tracker"].size(), 4u);
  EXPECT_EQ(frames["r0_from_base_link"].size(), 4u);
  EXPECT_EQ(frames["axes"].size(), 6u);
  EXPECT_EQ(frames["link_lengths_mm"].size(), 5u);
  EXPECT_EQ(frames["wrist"]["table"].size(), 3u);
  EXPECT_EQ(frames["tcp_in_flange_m"].size(), 3u);
  for (const char* key : {"center_m", "miss_mm", "radii_mm"}) EXPECT_TRUE(frames["wrist"].contains(key)) << key;
}

TEST(CommandLine, OneMethodAloneAndAnotherStep) {
  const ScratchFolder scratch;
  const Ran ran = runProgram("identify '" + kActive + "' --method pp --step 1 --json -", scratch.path());
  const auto json = nlohmann::json::parse(ran.out);
  EXPECT_EQ(json["step"], 1);
  EXPECT_EQ(json["methods"].size(), 1u);
  EXPECT_TRUE(json["methods"].contains("pp"));
  EXPECT_EQ(json["shown_first"]["reason"], "PP, as asked");
}

TEST(CommandLine, TheMethodShownFirstIsTheOneThatIsTaken) {
  const ScratchFolder scratch;
  const std::string springs = " '" + kActive + "' --springs-only --json -";
  const auto identify = nlohmann::json::parse(runProgram("identify" + springs, scratch.path()).out);
  EXPECT_EQ(identify["shown_first"]["method"], "pp");
  EXPECT_EQ(identify["posture_stiffness"]["method"], "pp");
  const auto at_targets = [&](const char* method) {
    return identify["methods"][method]["compensated_at_targets"]["held_out"].get<double>();
  };
  EXPECT_GT(at_targets("pp"), at_targets("dpp"));
  const auto& lengths = identify["characteristic_length"];
  EXPECT_LT(lengths["by_residual_variances"]["length_m"].get<double>(), lengths["length_m"].get<double>());
  EXPECT_GT(lengths["by_residual_variances"]["compensated"]["held_out"].get<double>(),
            identify["methods"]["cp"]["compensated"]["held_out"].get<double>());
  for (const auto& row : lengths["sensitivity"]) EXPECT_EQ(row["subsets"], 500);
  const auto compensate = nlohmann::json::parse(runProgram("compensate" + springs, scratch.path()).out);
  EXPECT_EQ(compensate["method"], "pp");
  const auto asked = nlohmann::json::parse(runProgram("compensate --method dpp" + springs, scratch.path()).out);
  EXPECT_EQ(asked["method"], "dpp");
  EXPECT_EQ(asked["shown_first"]["reason"], "DPP, as asked");
}

TEST(CommandLine, SimulateNamesJointsThatItTakesAsRigid) {
  const ScratchFolder scratch;
  std::string spec = contentsOf(STIFFSCOPE_SOURCE_DIR "/samples/active.xml");
  const auto joint = spec.find("<joint index=\"4\"");
  ASSERT_NE(joint, std::string::npos);
  spec.erase(joint, spec.find("/>", joint) + 2 - joint);
  std::ofstream(scratch.path() / "spec.xml") << spec;
  std::filesystem::copy(STIFFSCOPE_SOURCE_DIR "/samples/m900ib700.urdf", scratch.path() / "m900ib700.urdf");
  const Ran ran = runProgram(
      "simulate '" + (scratch.path() / "spec.xml").string() + "' --out '" + (scratch.path() / "day").string() + "'",
      scratch.path());
  EXPECT_EQ(ran.status, 0) << ran.err;
  EXPECT_NE(ran.err.find("spec.xml: joints: no stiffness_nm_per_rad for joint 4: taken as rigid"), std::string::npos)
      << ran.err;
}

TEST(CommandLine, CompensateTakesPosturesFromAFile) {
  const ScratchFolder scratch;
  const std::filesystem::path file = scratch.path() / "postures.csv";
  // The first row is the sample's pose 1, step 3, where the load hangs; nothing turns axis 1 there.
  std::istringstream states(contentsOf(kActive + "/states.csv"));
  std::string header, row;
  std::getline(states, header);
  for (int line = 0; line < 4; ++line) std::getline(states, row);
  ASSERT_EQ(row.rfind("1,3,", 0), 0u) << row;
  const std::string posture = row.substr(row.find(',', 4) + 1);
  std::ofstream(file) << "pose,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg,fx_n,fy_n,fz_n,mx_nm,my_nm,mz_nm\n"
                      << "hanging," << posture << "\nsingular,10,20,-10,40,0,30,0,0,0,0,0,0\n"
                      << "aside,0,10,10,0,-60,0,0,1000,0,0,0,0\n";
  const Ran ran =
      runProgram("compensate '" + kActive + "' --postures '" + file.string() + "' --json -", scratch.path());
  const auto rows = nlohmann::json::parse(ran.out)["rows"];
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_LT(rows[0]["remaining_mm"].get<double>(), 1e-5);
  EXPECT_EQ(rows[0]["tcp_deflection_mm"].size(), 3u);
  for (const int refused : {1, 2}) EXPECT_TRUE(rows[refused]["command_deg"].is_null());
  EXPECT_NE(rows[1]["refused"].get<std::string>().find("singularity"), std::string::npos);
  EXPECT_NE(rows[2]["refused"].get<std::string>().find("k1 is not known"), std::string::npos);
}

TEST(CommandLine, CompensateKnowsHowFarTheDayReaches) {
  const ScratchFolder scratch;
  const std::filesystem::path campaign = scratch.path() / "known", file = scratch.path() / "postures.csv";
  std::filesystem::copy(kActive, campaign);
  std::string xml = contentsOf((campaign / "campaign.xml").string());
  xml.insert(xml.find("<tool "),
             "<known_stiffness joint=\"1\" nm_per_rad=\"8e6\" sd_nm_per_rad=\"4e5\" source=\"maker\"/>");
  std::ofstream(campaign / "campaign.xml") << xml;
  std::ofstream(file) << "pose,q1_deg,q2_deg,q3_deg,q4_deg,q5_deg,q6_deg,fx_n,fy_n,fz_n,mx_nm,my_nm,mz_nm\n"
                      << "aside,0,10,10,0,-60,0,0,1000,0,0,0,0\nheavy,0,10,10,0,-60,0,0,20000,0,0,0,0\n"
                      << "heavier,0,10,10,0,-60,0,0,25000,0,0,0,0\n";
  const Ran ran =
      runProgram("compensate '" + campaign.string() + "' --postures '" + file.string() + "' --json -", scratch.path());
  EXPECT_EQ(ran.status, 1) << ran.err;  // most are refused
  const auto json = nlohmann::json::parse(ran.out);
  const auto& rows = json["rows"];
  ASSERT_EQ(rows.size(), 3u);
  for (const int heavy : {1, 2}) {
    EXPECT_NE(rows[heavy]["refused"].get<std::string>().find("times the largest"), std::string::npos) << rows[heavy];
    EXPECT_EQ(rows[heavy]["tcp_deflection_mm"].size(), 3u);
  }
  EXPECT_EQ(json["summary"]["refused"][0]["postures"], 2);
  // The interval of a coordinate holds what is predicted and is as wide as k1's 5 % and more.
  const auto& interval = rows[0]["interval_tcp_deflection_mm"];
  for (int k = 0; k < 3; ++k) {
    EXPECT_LE(interval[k][0].get<double>(), rows[0]["tcp_deflection_mm"][k].get<double>());
    EXPECT_GE(interval[k][1].get<double>(), rows[0]["tcp_deflection_mm"][k].get<double>());
  }
  EXPECT_GT(rows[0]["u_tcp_deflection_mm"].get<double>(), 0.0);
  ASSERT_EQ(json["known_stiffness"].size(), 1u);
  EXPECT_EQ(json["known_stiffness"][0]["source"], "maker");
}

TEST(CommandLine, NegativeStiffnessesAreNotASuccess) {
  const ScratchFolder scratch;
  const std::filesystem::path campaign = scratch.path() / "negative";
  std::filesystem::copy(kActive, campaign);
  std::istringstream states(contentsOf(campaign / "states.csv"));
  std::ostringstream turned;
  std::string line;
  std::getline(states, line);
  turned << line << '\n';
  while (std::getline(states, line)) {  // the last six cells, force and moment, change sign
    std::size_t at = line.size();
    for (int cell = 0; cell < 6; ++cell) {
      at = line.rfind(',', at - 1);
      line[at + 1] == '-' ? line.erase(at + 1, 1) : line.insert(at + 1, "-");
    }
    turned << line << '\n';
  }
  std::ofstream(campaign / "states.csv") << turned.str();
  const Ran ran = runProgram("identify '" + campaign.string() + "'", scratch.path());
  EXPECT_EQ(ran.status, 1);
  EXPECT_NE(ran.out.find("every stiffness is negative"), std::string::npos) << ran.out;
}

TEST(CommandLine, ConditionNumbersSayOfWhat) {
  const ScratchFolder scratch;
  const std::string text = runProgram("identify '" + kActive + "' --method dpp --postures", scratch.path()).out;
  EXPECT_NE(text.find("condition: condition number of the method's equations"), std::string::npos) << text;
  EXPECT_NE(text.find("kappa: condition number of the posture's Jacobian"), std::string::npos) << text;
}

TEST(CommandLine, WhatRoundsToZeroHasNoSign) {
  const ScratchFolder scratch;
  const std::string text = runProgram("frames '" + kActive + "'", scratch.path()).out;
  EXPECT_NE(text.find(" 0.000000"), std::string::npos) << text;
  EXPECT_FALSE(std::regex_search(text, std::regex("-0\\.0+[^0-9]"))) << text;
}

TEST(CommandLine, RefusesValuesThatNobodyMeans) {
  const ScratchFolder scratch;
  const std::string sample = " '" STIFFSCOPE_SOURCE_DIR "/samples/active' ";
  const std::pair<std::string, std::string> refused[] = {
      {"plan" + sample + "--hook 1,2,nan", "--hook: 'nan': expected a finite number"},
      {"plan" + sample + "--load 1e400", "--load: '1e400': expected a finite number"},
      {"plan" + sample + "--seed -1", "--seed: '-1': expected a whole number from 0 to"},
      {"identify" + sample + "--json ''", "--json: expected a value; it is empty"},
      {"identify" + sample + "--step ''", "--step: expected a value; it is empty"}};
  for (const auto& [words, said] : refused) {
    const Ran ran = runProgram(words, scratch.path());
    EXPECT_EQ(ran.status, 2) << words;
    EXPECT_NE(ran.err.find(said), std::string::npos) << ran.err;
  }
}

}  // namespace command_line_test
}  // namespace stiffscope
