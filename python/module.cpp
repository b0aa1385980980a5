#include <fmt/format.h>
#include <pybind11/eigen.h>
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "app/computations.h"
#include "core/campaign/columns.h"
#include "core/campaign/read_campaign.h"
#include "core/identification/motor_side.h"
#include "core/io/input_error.h"
#include "core/io/read_file.h"
#include "core/io/read_points.h"
#include "core/io/units.h"
#include "core/numerics/parallel.h"
#include "python/to_python.h"

namespace py = pybind11;

// stiffscope._core: what the package around it wraps. Every function takes plain values and returns a result as a tuple
// (JSON's values, text, warnings, why it does not serve, the command's exit status).

namespace stiffscope::python {

namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A campaign in memory. What is used of it is prepared once, raw and not.
class OpenedCampaign {
 public:
  OpenedCampaign(const std::string& folder_or_xml, bool kept) : path_(folder_or_xml), kept_(kept) {
    const py::gil_scoped_release others_run;
    campaign::CampaignReading reading = campaign::readCampaign(folder_or_xml);
    read_ = std::move(reading.campaign);
    warnings_ = std::move(reading.warnings);
    for (const campaign::InputFile& input : read_.inputs)
      inputs_.push_back(std::filesystem::absolute(read_.folder / input.name));
  }

  const std::string& path() const { return path_; }
  const std::vector<std::string>& warnings() const { return warnings_; }
  const campaign::Campaign& read() const { return read_; }

  /// Makes its files inputs of the calling thread's run, which may have been opened long before.
  void recordInputs() const {
    for (const std::filesystem::path& input : inputs_) {
      if (const auto stamp = io::stampOf(input)) io::recordRead(*stamp);
    }
  }

  std::shared_ptr<const preparation::PreparedCampaign> prepared(bool raw) {
    const std::lock_guard<std::mutex> one_at_a_time(mutex_);
    std::shared_ptr<const preparation::PreparedCampaign>& made = prepared_[raw ? 1 : 0];
    if (made) return made;
    // One that serves a single call is not copied.
    campaign::Campaign used = identification::referredToMotors(kept_ ? read_ : std::move(read_));
    made = std::make_shared<const preparation::PreparedCampaign>(raw ? preparation::leaveRaw(std::move(used))
                                                                     : preparation::prepareCampaign(std::move(used)));
    return made;
  }

 private:
  std::string path_;
  bool kept_;
  campaign::Campaign read_;
  std::vector<std::string> warnings_;
  std::vector<std::filesystem::path> inputs_;
  std::mutex mutex_;
  std::array<std::shared_ptr<const preparation::PreparedCampaign>, 2> prepared_;
};

using Opened = std::shared_ptr<OpenedCampaign>;

app::CampaignSource sourceOf(const Opened& campaign, bool raw) {
  campaign->recordInputs();
  return {campaign->path(), [campaign, raw] { return campaign->prepared(raw); }};
}

/// Runs a computation without the GIL; what it hands over becomes Python's. Its inputs are the files that it reads and
/// those of its campaigns (sourceOf): what earlier calls have read may be written.
template <class Compute>
py::tuple resultOf(const Compute& compute) {
  py::object values = py::none();
  std::string text, reason;
  std::vector<std::string> warnings;
  int status = 0;
  {
    const py::gil_scoped_release others_run;
    const io::OneRun run;
    const app::Outlet outlet{[&](const auto& json, const auto& in_words) {
                               text = in_words();
                               const reports::JsonDocument document = json();
                               py::object made = toPython(document);
                               const py::gil_scoped_acquire gil;
                               values = std::move(made);
                             },
                             [&](const std::string& warning) { warnings.push_back(warning); },
                             [&](const std::string& line) { reason = line; }};
    status = compute(outlet);
  }
  return py::make_tuple(values, text, warnings, reason, status);
}

double checked(double value, campaign::CellKind kind, const io::InputPlace& place) {
  const campaign::NumberKind& number = campaign::numberKind(kind);
  if (std::abs(value) <= number.limit) return value * number.si_per_unit;
  throw io::InputError(place, fmt::format("{}", value), number.expectation);
}

/// Rows of arrays as the lines of a file of postures: the same columns, units and limits, angles as the controller
/// states them.
std::vector<compensation::PostureToCompensate> posturesOf(const std::vector<std::string>& ids, const Rows& q_deg,
                                                          const Rows& wrenches) {
  constexpr std::array kWrench{"fx_n", "fy_n", "fz_n", "mx_nm", "my_nm", "mz_nm"};
  std::vector<compensation::PostureToCompensate> postures(static_cast<std::size_t>(q_deg.rows()));
  for (std::size_t i = 0; i < postures.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    postures[i].id = ids.at(i);
    postures[i].q.resize(q_deg.cols());
    for (Eigen::Index j = 0; j < q_deg.cols(); ++j) {
      postures[i].q[j] =
          checked(q_deg(row, j), campaign::CellKind::degree, {"postures", i + 1, fmt::format("q{}_deg", j + 1)});
    }
    for (Eigen::Index j = 0; j < wrenches.cols(); ++j) {
      postures[i].wrench_in_cell[j] =
          checked(wrenches(row, j), j < 3 ? campaign::CellKind::newton : campaign::CellKind::newton_metre,
                  {"wrenches", i + 1, kWrench[static_cast<std::size_t>(j)]});
    }
  }
  return postures;
}

std::vector<Eigen::Vector3d> pointsOf(const Rows& rows) {
  std::vector<Eigen::Vector3d> points;
  points.reserve(static_cast<std::size_t>(rows.rows()));
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      if (std::isfinite(rows(i, j))) continue;
      throw io::InputError({"points", static_cast<std::size_t>(i) + 1, std::string(1, "xyz"[j])},
                           fmt::format("{}", rows(i, j)), "expected a finite number");
    }
    points.emplace_back(rows(i, 0), rows(i, 1), rows(i, 2));
  }
  return points;
}

void raiseInputError(const io::InputError& error) {
  const py::object type = py::module_::import("stiffscope._errors").attr("InputError");
  const io::InputPlace& place = error.place();
  const py::object instance =
      type(error.what(), place.file, place.line, place.column, error.value(), error.expectation());
  PyErr_SetObject(type.ptr(), instance.ptr());
}

app::ModelChoice modelOf(std::vector<std::string> with, bool springs_only) {
  if (springs_only && !with.empty())
    throw io::InputError({"--springs-only"}, "True", "expected without with_: joint springs and nothing else");
  return {std::move(with), springs_only};
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  numerics::sumAlikeEverywhere();
  module.attr("__version__") = STIFFSCOPE_VERSION;
  module.attr("default_folds") = calibration::CalibrationOptions().folds;
  module.attr("default_fold_size") = calibration::CalibrationOptions().fold_size;
  module.attr("default_repeats") = app::PlanRequest().repeats;
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const io::InputError& error) {
      raiseInputError(error);
    } catch (const std::filesystem::filesystem_error& error) {
      PyErr_SetString(PyExc_OSError, error.what());
    }
  });

  py::class_<OpenedCampaign, Opened>(module, "Campaign")
      .def(py::init<const std::string&, bool>())
      .def_property_readonly("path", &OpenedCampaign::path)
      .def_property_readonly("warnings", &OpenedCampaign::warnings)
      .def_property_readonly("folder", [](const OpenedCampaign& it) { return it.read().folder.string(); })
      .def_property_readonly("name", [](const OpenedCampaign& it) { return it.read().name; })
      .def_property_readonly("date", [](const OpenedCampaign& it) { return it.read().date; })
      .def_property_readonly("robot", [](const OpenedCampaign& it) { return it.read().robot.name; })
      .def_property_readonly("joints", [](const OpenedCampaign& it) { return it.read().robot.joints(); })
      .def_property_readonly("postures", [](const OpenedCampaign& it) { return it.read().pose_ids; })
      .def("tables", [](const OpenedCampaign& it) { return tablesOf(it.read()); });

  module.def("audit", [](const Opened& campaign) {
    return resultOf([&](const auto& outlet) { return app::auditCampaign(sourceOf(campaign, false), outlet); });
  });
  module.def("frames", [](const Opened& campaign, bool raw, std::vector<std::string> with, bool springs_only) {
    const app::ModelChoice model = modelOf(std::move(with), springs_only);
    return resultOf([&](const auto& outlet) { return app::framesOf(sourceOf(campaign, raw), model, outlet); });
  });
  module.def("identify", [](const Opened& campaign, bool raw, std::vector<std::string> with, bool springs_only,
                            const std::string& method, const std::string& step, std::optional<int> subset_size,
                            int bootstrap, bool neglect_kc, bool robust) {
    app::IdentifyRequest request{method, step, subset_size, bootstrap, neglect_kc, robust, false, {}};
    request.model = modelOf(std::move(with), springs_only);
    return resultOf(
        [&](const auto& outlet) { return app::identifyCampaign(request, sourceOf(campaign, raw), true, outlet); });
  });
  module.def("calibrate", [](const Opened& campaign, bool raw, int folds, int fold_size, const std::string& angles,
                             const std::string& urdf, const std::string& csv) {
    app::CalibrateRequest request{{}, angles, urdf, csv};
    request.options.folds = folds;
    request.options.fold_size = fold_size;
    return resultOf(
        [&](const auto& outlet) { return app::calibrateCampaign(request, sourceOf(campaign, raw), outlet); });
  });
  module.def(
      "compensate", [](const Opened& campaign, bool raw, std::vector<std::string> with, bool springs_only,
                       const std::string& method, const std::string& step, const std::string& file,
                       const std::optional<std::vector<std::string>>& ids, const Rows& q_deg, const Rows& wrenches) {
        app::CompensateRequest request{{method, step, modelOf(std::move(with), springs_only), {}}, file, "", {}};
        if (ids) request.postures = posturesOf(*ids, q_deg, wrenches);
        return resultOf(
            [&](const auto& outlet) { return app::compensateCampaign(request, sourceOf(campaign, raw), outlet); });
      });
  module.def("compare", [](const Opened& before, const Opened& after, bool raw, std::vector<std::string> with,
                           bool springs_only, const std::string& step, bool neglect_kc, std::uint64_t seed) {
    const app::CompareRequest request{step, neglect_kc, modelOf(std::move(with), springs_only), seed};
    return resultOf([&](const auto& outlet) {
      return app::compareTwo(request, sourceOf(before, raw), sourceOf(after, raw), outlet);
    });
  });
  module.def("diagnose", [](const Opened& campaign, const std::string& angles) {
    return resultOf(
        [&](const auto& outlet) { return app::diagnoseCampaign(angles, sourceOf(campaign, false), outlet); });
  });
  module.def(
      "plan", [](const Opened& campaign, std::vector<std::string> with, bool springs_only, std::optional<int> postures,
                 std::optional<int> add, std::optional<double> load, std::optional<double> pull,
                 std::vector<double> hook_mm, std::vector<double> tracker_mm, std::vector<double> min_deg,
                 std::vector<double> max_deg, int repeats, bool unloaded, const std::string& criterion,
                 std::optional<int> candidates, std::uint64_t seed, const std::string& out) {
        const app::PlanRequest request{out,
                                       criterion,
                                       unloaded,
                                       load,
                                       pull,
                                       add,
                                       postures,
                                       candidates,
                                       std::move(hook_mm),
                                       std::move(tracker_mm),
                                       std::move(min_deg),
                                       std::move(max_deg),
                                       repeats,
                                       seed,
                                       modelOf(std::move(with), springs_only)};
        return resultOf([&](const auto& outlet) { return app::planDay(request, sourceOf(campaign, false), outlet); });
      });
  module.def("simulate", [](const std::string& spec, const std::string& out, bool replace) {
    return resultOf([&](const auto& outlet) { return app::simulateDay({spec, out, replace}, outlet); });
  });
  module.def("fit", [](const std::string& shape, const std::string& file, const Rows& points,
                       const std::string& strategy, bool robust) {
    const auto read = [&] { return file.empty() ? pointsOf(points) : io::readPoints(file); };
    return resultOf([&](const auto& outlet) {
      return app::fitPoints({shape, strategy, robust}, file.empty() ? "points" : file, read, outlet);
    });
  });
}

}  // namespace stiffscope::python
