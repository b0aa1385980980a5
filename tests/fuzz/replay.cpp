#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "tests/fuzz/expect_input_error.h"
#include "tests/fuzz/mutate.h"

// replay CORPUS WORDS COUNT: every file of the corpus, and COUNT of its mutations with a fixed seed, through the parser
// that this program is linked with. For compilers without libFuzzer; scripts/fuzz is the longer search.

namespace {

std::string contentOf(const std::filesystem::path& file) {
  std::ostringstream bytes;
  bytes << std::ifstream(file, std::ios::binary).rdbuf();
  return bytes.str();
}

// In the order of names: a folder lists its files in any.
std::vector<std::string> textsIn(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> texts;
  for (const auto& file : files) texts.push_back(contentOf(file));
  return texts;
}

// Lines of libFuzzer's dictionary: "word", with \" for a quote.
std::vector<std::string> wordsIn(const std::filesystem::path& file) {
  std::ifstream lines(file);
  std::vector<std::string> words;
  for (std::string line; std::getline(lines, line);) {
    if (line.size() < 2 || line.front() != '"') continue;
    line = line.substr(1, line.size() - 2);
    std::erase(line, '\\');
    words.push_back(line);
  }
  return words;
}

void run(const std::string& text) {
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
}

}  // namespace

int main(int count, char** words) {
  if (count != 4) {
    std::fprintf(stderr, "replay CORPUS WORDS COUNT\n");
    return 2;
  }
  const std::vector<std::string> texts = textsIn(words[1]);
  if (texts.empty()) {
    std::fprintf(stderr, "%s: no corpus\n", words[1]);
    return 2;
  }
  for (const std::string& text : texts) run(text);
  stiffscope::fuzz::Mutator mutator(texts, wordsIn(words[2]), 1);
  std::string mutated;
  try {
    for (int i = 0; i < std::stoi(words[3]); ++i) run(mutated = mutator.next());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "not an InputError: %s\n%s\n", error.what(), mutated.c_str());
    return 1;
  }
  std::printf("%zu files, %s mutations\n", texts.size(), words[3]);
  return 0;
}
