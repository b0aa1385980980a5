#include <benchmark/benchmark.h>
#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vtkDelimitedTextReader.h>
#include <vtkSmartPointer.h>
#include <vtkTable.h>

#include "bench/large_campaign.h"
#include "core/campaign/read_campaign.h"

// Reading of large campaigns from files that are in the page cache, checks and hashes included: megabytes of input a
// second, and the peak memory of a process that reads once and does nothing else, as a multiple of the input. Beside it
// VTK's reader of delimited text with its numbers detected, which checks no key, unit, name or encoding.

namespace {

namespace fs = std::filesystem;

/// A folder of campaigns, each written when it is first asked for, removed at the end.
class Campaigns {
 public:
  Campaigns() {
    std::string name = (fs::temp_directory_path() / "stiffscope-bench-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder: " + name);
    folder_ = name;
  }
  ~Campaigns() { fs::remove_all(folder_); }

  fs::path postures(std::int64_t count) const {
    return written("postures", count, stiffscope::bench::writeManyPostures);
  }
  fs::path sweep(std::int64_t readings) const {
    return written("sweep", readings, stiffscope::bench::writeLongWristSweep);
  }

 private:
  template <class Write>
  fs::path written(const char* kind, std::int64_t count, const Write& write) const {
    fs::path folder = folder_ / (kind + std::to_string(count));
    if (!fs::exists(folder)) write(folder, static_cast<int>(count));
    return folder;
  }

  fs::path folder_;
};

const Campaigns& campaigns() {
  static const Campaigns written;
  return written;
}

double bytesIn(const fs::path& folder) {
  double bytes = 0.0;
  for (const auto& entry : fs::directory_iterator(folder)) bytes += static_cast<double>(entry.file_size());
  return bytes;
}

/// Peak resident memory of a child that runs `work`, beyond what a child has that does nothing.
template <class Work>
double peakBytes(const Work& work) {
  const auto peak = [](const auto& task) {
    ::malloc_trim(0);  // what earlier runs left behind is no part of the baseline
    const pid_t child = ::fork();
    if (child == 0) {
      task();
      ::_exit(0);
    }
    rusage usage{};
    ::wait4(child, nullptr, 0, &usage);
    return 1024.0 * static_cast<double>(usage.ru_maxrss);
  };
  return peak(work) - peak([] {});
}

template <class Work>
void reading(benchmark::State& state, double bytes, const Work& work) {
  for (auto _ : state) work();
  state.counters["MB/s"] = benchmark::Counter(1e-6 * bytes, benchmark::Counter::kIsIterationInvariantRate);
  state.counters["MB"] = 1e-6 * bytes;
  state.counters["peak/input"] = peakBytes(work) / bytes;
}

void readingCampaign(benchmark::State& state, const fs::path& folder) {
  reading(state, bytesIn(folder), [&] { benchmark::DoNotOptimize(stiffscope::campaign::readCampaign(folder)); });
}

void ReadPostures(benchmark::State& state) { readingCampaign(state, campaigns().postures(state.range(0))); }
BENCHMARK(ReadPostures)->Arg(100)->Arg(1000)->Arg(10000)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

void ReadWristSweep(benchmark::State& state) { readingCampaign(state, campaigns().sweep(state.range(0))); }
BENCHMARK(ReadWristSweep)
    ->Arg(10000)
    ->Arg(100000)
    ->Arg(1000000)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();

void ReadWristSweepByVtk(benchmark::State& state) {
  const fs::path file = campaigns().sweep(state.range(0)) / "wrist_sweep.csv";
  reading(state, static_cast<double>(fs::file_size(file)), [&] {
    const auto reader = vtkSmartPointer<vtkDelimitedTextReader>::New();
    reader->SetFileName(file.c_str());
    reader->SetHaveHeaders(true);
    reader->SetDetectNumericColumns(true);
    reader->Update();
    benchmark::DoNotOptimize(reader->GetOutput()->GetNumberOfRows());
  });
}
BENCHMARK(ReadWristSweepByVtk)
    ->Arg(10000)
    ->Arg(100000)
    ->Arg(1000000)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime()
    ->Iterations(1);

}  // namespace

BENCHMARK_MAIN();
