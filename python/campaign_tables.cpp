#include "python/to_python.h"

#include <pybind11/numpy.h>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/campaign/joint_reading.h"
#include "core/campaign/table_layouts.h"

namespace py = pybind11;

namespace stiffscope::python {

namespace {

using campaign::CellKind;

const std::vector<std::string>& namesOfKind(CellKind kind, const campaign::Campaign& campaign,
                                            const std::vector<std::string>& targets) {
  if (kind == CellKind::target) return targets;
  return kind == CellKind::pose ? campaign.pose_ids : campaign.nest_ids;
}

std::vector<std::string> stationNames(const campaign::Campaign& campaign) {
  std::vector<std::string> names;
  for (const campaign::StationPlace& station : campaign.stations) names.push_back(station.id);
  return names;
}

template <class Row>
class TableColumns {
 public:
  TableColumns(const campaign::Campaign& campaign, std::vector<Row>& rows) : campaign_(campaign), rows_(rows) {
    for (const campaign::Target& target : campaign.targets) targets_.push_back(target.id);
  }

  py::dict of(const campaign::TableLayout<Row>& layout) {
    py::dict columns;
    for (const campaign::Column<Row>& column : layout.columns) {
      const py::object values = valuesOf(column);
      if (!values.is_none()) columns[py::str(column.name)] = values;
    }
    return columns;
  }

 private:
  /// Names, as they are written; none where no row has one.
  py::object repeats(const typename campaign::Column<Row>::Index& member) {
    py::list values;
    bool some = false;
    for (Row& row : rows_) {
      const int repeat = member(row);
      some = some || repeat != campaign::kNoRepeat;
      if (repeat >= campaign::kNoRepeat) {
        values.append(repeat == campaign::kNoRepeat ? std::string() : std::to_string(repeat));
      } else {
        values.append(campaign_.repeat_ids.at(static_cast<std::size_t>(campaign::repeatByName(repeat))));
      }
    }
    return some ? py::object(std::move(values)) : py::none();
  }

  /// None for an optional column without a value.
  py::object valuesOf(const campaign::Column<Row>& column) {
    if (const auto* number = std::get_if<typename campaign::Column<Row>::Number>(&column.member)) {
      const double unit = campaign::numberKind(column.kind).si_per_unit;
      py::array_t<double> values(static_cast<py::ssize_t>(rows_.size()));
      double* to = values.mutable_data();
      bool some = false;
      for (Row& row : rows_) {
        const double value = (*number)(row) / unit;
        *to++ = value;
        some = some || !std::isnan(value);
      }
      return some || column.required ? py::object(std::move(values)) : py::none();
    }
    if (const auto* index = std::get_if<typename campaign::Column<Row>::Index>(&column.member)) {
      if (column.kind == CellKind::axis || column.kind == CellKind::step) {
        py::array_t<std::int64_t> values(static_cast<py::ssize_t>(rows_.size()));
        std::int64_t* to = values.mutable_data();
        for (Row& row : rows_) *to++ = (*index)(row) + (column.kind == CellKind::axis ? 1 : 0);
        return std::move(values);
      }
      if (column.kind == CellKind::station) {
        if (campaign_.stations.empty()) return py::none();
        const std::vector<std::string> stations = stationNames(campaign_);
        py::list values;
        for (Row& row : rows_) values.append(stations.at(static_cast<std::size_t>((*index)(row))));
        return std::move(values);
      }
      if (column.kind == CellKind::repeat) return repeats(*index);
      const std::vector<std::string>& names = namesOfKind(column.kind, campaign_, targets_);
      py::list values;
      for (Row& row : rows_) values.append(names.at(static_cast<std::size_t>((*index)(row))));
      return std::move(values);
    }
    const auto text = std::get<typename campaign::Column<Row>::Text>(column.member);
    py::list values;
    bool some = false;
    for (Row& row : rows_) {
      values.append(text(row));
      some = some || !text(row).empty();
    }
    return some || column.required ? py::object(std::move(values)) : py::none();
  }

  const campaign::Campaign& campaign_;
  std::vector<Row>& rows_;
  std::vector<std::string> targets_;
};

template <class Row>
void add(const campaign::TableLayout<Row>& layout, campaign::Campaign& campaign,
         std::optional<campaign::Table<Row>>& table, py::dict& tables) {
  if (table) tables[py::str(layout.element)] = TableColumns<Row>(campaign, table->rows).of(layout);
}

}  // namespace

py::dict tablesOf(campaign::Campaign campaign) {
  campaign::anglesToFigures(campaign);
  const int joints = campaign.robot.joints();
  py::dict tables;
  add(campaign::circleSweepsLayout(joints), campaign, campaign.circle_sweeps, tables);
  add(campaign::wristSweepLayout(joints), campaign, campaign.wrist_sweep, tables);
  add(campaign::railSweepLayout(), campaign, campaign.rail_sweep, tables);
  add(campaign::loadingLayout(), campaign, campaign.loading, tables);
  add(campaign::statesLayout(joints), campaign, campaign.states, tables);
  add(campaign::displacementsLayout(), campaign, campaign.displacements, tables);
  add(campaign::nestsLayout(), campaign, campaign.nests, tables);
  return tables;
}

}  // namespace stiffscope::python
