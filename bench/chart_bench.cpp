#include <benchmark/benchmark.h>
#include "render/grouped_bar_chart.h"
#include "render/image.h"

// A grouped bar chart like the paper's Fig. 7, drawn and encoded as PNG: 10, 30 and 60 postures of four bars. The
// library that draws is loaded before the time is taken, as matplotlib is imported before its own is.

namespace {

using namespace stiffscope;

render::GroupedBarChart chartOf(int postures) {
  render::GroupedBarChart chart{
      "Displacement of P_{wrist}", "benchmark", "Displacement of P_{wrist} (mm)", "Posture", {}, {}};
  const struct {
    const char* name;
    render::Colour colour;
  } kinds[] = {
      {"without compensation", {128, 128, 128}}, {"CP", {200, 40, 40}}, {"PP", {40, 80, 200}}, {"DPP", {40, 160, 60}}};
  for (const auto& kind : kinds) chart.series.push_back({kind.name, kind.colour, {}, {}});
  for (int p = 0; p < postures; ++p) {
    chart.categories.push_back(std::to_string(p + 1));
    for (std::size_t s = 0; s < chart.series.size(); ++s) {
      chart.series[s].values.push_back((2.0 + 0.1 * ((7 * p) % 13)) / static_cast<double>(1 + 2 * s));
    }
  }
  return chart;
}

void Chart(benchmark::State& state) {
  const render::GroupedBarChart chart = chartOf(static_cast<int>(state.range(0)));
  benchmark::DoNotOptimize(render::render(chart));
  for (auto _ : state) benchmark::DoNotOptimize(render::encodePng(render::render(chart)));
}
BENCHMARK(Chart)->Arg(10)->Arg(30)->Arg(60)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();

}  // namespace

BENCHMARK_MAIN();
