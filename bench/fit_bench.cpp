#include <benchmark/benchmark.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <random>
#include <vector>

#include "bench/shared_data.h"
#include "metrology/circle_fit.h"
#include "metrology/cylinder_fit.h"
#include "metrology/plane_fit.h"
#include "metrology/sphere_fit.h"

// Fits at 20, 1,000 and 1,000,000 points of a metre-sized shape, 20 um noise, 3 m from the tracker. Beside
// them what libraries offer: OpenCV's ellipse, Eigen's eigen-decomposition for the plane and its least
// squares for Kasa's sphere; and, by fits_by_scipy.py on the same points, scipy's least squares.

namespace {

namespace metrology = stiffscope::metrology;

constexpr double kNoise = 2e-5;

metrology::MeasuredPoints noisy(std::size_t count, Eigen::Vector3d (*ideal)(double, double), std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, kNoise);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  metrology::MeasuredPoints points;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d error(normal(random), normal(random), normal(random));
    points.points.push_back(ideal(uniform(random), uniform(random)) + error);
  }
  return points;
}

Eigen::Vector3d turned(const Eigen::Vector3d& point) {
  return Eigen::Vector3d(3.0, -1.0, 0.5) + Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 2) / 3.0) * point;
}
Eigen::Vector3d onQuarterCircle(double s, double) {
  const double angle = 0.5 * std::numbers::pi * s;
  return turned({1.2 * std::cos(angle), 1.2 * std::sin(angle), 0.0});
}
Eigen::Vector3d onCap(double s, double t) {
  const double angle = 2.0 * std::numbers::pi * s, z = 0.3 + 0.7 * t, across = std::sqrt(1.0 - z * z);
  return turned({0.6 * across * std::cos(angle), 0.6 * across * std::sin(angle), 0.6 * z});
}
Eigen::Vector3d onSquare(double s, double t) { return turned({s, t, 0.0}); }
Eigen::Vector3d onTube(double s, double t) {
  const double angle = 2.0 * std::numbers::pi * s;
  return turned({0.3 * std::cos(angle), 0.3 * std::sin(angle), t});
}

void sizes(benchmark::internal::Benchmark* one) {
  one->Arg(20)->Arg(1000)->Arg(1000000)->Unit(benchmark::kMicrosecond);
}

std::vector<metrology::MeasuredPoints> tenThousandCircles() {
  std::vector<metrology::MeasuredPoints> circles;
  for (std::uint64_t seed = 0; seed < 10000; ++seed) circles.push_back(noisy(20, onQuarterCircle, seed));
  return circles;
}

/// The figure that is promised: 10,000 circles of 20 points in under 0.1 s.
void TenThousandCirclesOf20Points(benchmark::State& state) {
  const std::vector<metrology::MeasuredPoints> circles = tenThousandCircles();
  for (auto _ : state) {
    for (const metrology::MeasuredPoints& circle : circles) benchmark::DoNotOptimize(metrology::fitCircle(circle));
  }
}
BENCHMARK(TenThousandCirclesOf20Points)->Unit(benchmark::kMillisecond);

template <class Fit>
void fitting(benchmark::State& state, const metrology::MeasuredPoints& points, const Fit& fit) {
  for (auto _ : state) benchmark::DoNotOptimize(fit(points));
  using benchmark::Counter;
  state.counters["per_point"] =
      Counter(static_cast<double>(points.points.size()), Counter::kIsIterationInvariantRate | Counter::kInvert);
}

void Circle(benchmark::State& state) {
  fitting(state, noisy(static_cast<std::size_t>(state.range(0)), onQuarterCircle),
          [](const metrology::MeasuredPoints& points) { return metrology::fitCircle(points); });
}
BENCHMARK(Circle)->Apply(sizes);

void CirclePlaneFirst(benchmark::State& state) {
  fitting(state, noisy(static_cast<std::size_t>(state.range(0)), onQuarterCircle),
          [](const metrology::MeasuredPoints& points) {
            return metrology::fitCircle(points, metrology::CircleStrategy::plane_first);
          });
}
BENCHMARK(CirclePlaneFirst)->Apply(sizes);

void Sphere(benchmark::State& state) {
  fitting(state, noisy(static_cast<std::size_t>(state.range(0)), onCap), metrology::fitSphere);
}
BENCHMARK(Sphere)->Apply(sizes);

void Plane(benchmark::State& state) {
  fitting(state, noisy(static_cast<std::size_t>(state.range(0)), onSquare), metrology::fitPlane);
}
BENCHMARK(Plane)->Apply(sizes);

void Cylinder(benchmark::State& state) {
  fitting(state, noisy(static_cast<std::size_t>(state.range(0)), onTube), metrology::fitCylinder);
}
BENCHMARK(Cylinder)->Apply(sizes);

/// The plane across the least principal axis, by Eigen alone: no uncertainty, no checks.
void PlaneByEigen(benchmark::State& state) {
  fitting(state, noisy(static_cast<std::size_t>(state.range(0)), onSquare),
          [](const metrology::MeasuredPoints& points) {
            const Eigen::Map<const Eigen::Matrix3Xd> all(points.points.front().data(), 3,
                                                         static_cast<Eigen::Index>(points.points.size()));
            const Eigen::Matrix3Xd centred = all.colwise() - all.rowwise().mean();
            return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(centred * centred.transpose()).eigenvectors().eval();
          });
}
BENCHMARK(PlaneByEigen)->Apply(sizes);

/// Kasa's sphere, linear least squares by Eigen's QR: biased on short arcs, no uncertainty.
void KasaSphereByEigen(benchmark::State& state) {
  fitting(state, noisy(static_cast<std::size_t>(state.range(0)), onCap), [](const metrology::MeasuredPoints& points) {
    const auto count = static_cast<Eigen::Index>(points.points.size());
    Eigen::MatrixX4d rows(count, 4);
    Eigen::VectorXd squares(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Vector3d& point = points.points[static_cast<std::size_t>(i)];
      rows.row(i) << 2.0 * point.transpose(), 1.0;
      squares[i] = point.squaredNorm();
    }
    return rows.householderQr().solve(squares).eval();
  });
}
BENCHMARK(KasaSphereByEigen)->Apply(sizes);

/// OpenCV has no circle or sphere in space; its ellipse of flat points in single precision is the nearest to
/// one.
void FlatEllipseByOpenCv(benchmark::State& state) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0.0, kNoise);
  std::vector<cv::Point2f> points;
  for (int i = 0; i < state.range(0); ++i) {
    const double angle = 0.5 * std::numbers::pi * i / static_cast<double>(state.range(0));
    points.emplace_back(static_cast<float>(1.2 * std::cos(angle) + normal(random)),
                        static_cast<float>(1.2 * std::sin(angle) + normal(random)));
  }
  for (auto _ : state) benchmark::DoNotOptimize(cv::fitEllipse(points));
}
BENCHMARK(FlatEllipseByOpenCv)->Apply(sizes);

void append(const metrology::MeasuredPoints& points, std::vector<double>& all) {
  for (const Eigen::Vector3d& point : points.points) all.insert(all.end(), point.begin(), point.end());
}

template <class Shape>
void appendRound(const Shape& shape, std::vector<double>& all) {
  all.insert(all.end(), shape.centre.begin(), shape.centre.end());
  all.push_back(shape.radius);
}

/// Points, and the centres and radii we find, as NAME.points and NAME.fits.
void writeFits(const std::filesystem::path& folder) {
  std::vector<double> points, fits;
  const auto write = [&](const std::string& name) {
    stiffscope::bench::writeDoubles(folder / (name + ".points"), points);
    stiffscope::bench::writeDoubles(folder / (name + ".fits"), fits);
    points.clear(), fits.clear();
  };
  for (const metrology::MeasuredPoints& circle : tenThousandCircles()) {
    append(circle, points);
    appendRound(metrology::fitCircle(circle).circle, fits);
  }
  write("TenThousandCirclesOf20Points");
  for (const std::size_t count : {20, 1000, 1000000}) {
    const metrology::MeasuredPoints circle = noisy(count, onQuarterCircle), sphere = noisy(count, onCap);
    append(circle, points);
    appendRound(metrology::fitCircle(circle).circle, fits);
    write("Circle_" + std::to_string(count));
    append(sphere, points);
    appendRound(metrology::fitSphere(sphere).sphere, fits);
    write("Sphere_" + std::to_string(count));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (const auto folder = stiffscope::bench::dataFolder(argc, argv)) writeFits(*folder);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
}
