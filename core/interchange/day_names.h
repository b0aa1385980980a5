#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/interchange/day_files.h"
#include "core/interchange/state_join.h"

namespace stiffscope::interchange {

/// What the names of points say by DAY.xml: reflector, pose, step, repeat, axis, or nest.
class DayNames {
 public:
  /// Of a machine of so many joints. `day` has to live as long.
  DayNames(const DayDescription& day, int joints) : day_(day), joints_(joints) {}

  /// A point of the file of that place in DayDescription::points as a reading of a reflector; nullopt where its name is
  /// none of the role's. Throws InputError for a step or an axis that is none.
  std::optional<DayReading> readingOf(std::size_t source, const PointReading& point) const;

  /// The name of the nest that a point is of, by the source's target where it has one; empty where it is of none.
  /// Without `only` all names are nests that are no reflectors.
  std::string nestOf(const PointsSource& source, const PointReading& point) const;

  /// The rows of lost beams whose names are of the role.
  std::vector<DayReading> lostReadings(std::size_t source, const PointFile& points) const;

  /// Of the files looked at, by axis and step: how often names occur, and in which file first.
  struct Occurrences {
    int count = 0;
    std::string file;
  };
  using OccurrencesByStep = std::map<std::pair<int, int>, Occurrences>;

  /// Where names have no pose, their occurrence is the pose: throws InputError where the reflectors of a file, or those
  /// of files before it (`before`, to which it is added), were not read equally often, so that an occurrence of one is
  /// another pose than that of another. Lost beams count.
  void requireEqualOccurrences(std::size_t source, const PointFile& points, OccurrencesByStep& before) const;

  /// A file of which nothing is of its role is another file, or its names are others: throws InputError. `of` is what
  /// was expected.
  [[noreturn]] void refuseNames(std::size_t source, const PointFile& points, const char* of) const;

 private:
  using Fields = std::map<std::string, std::string>;
  /// What a point's name says; nullopt where it is none of the source's. A file of one reflector needs no names.
  static std::optional<Fields> fieldsOf(const PointsSource& source, const PointReading& point);
  std::string mapped(const std::string& name) const;
  int targetNamed(const std::string& name) const;

  const DayDescription& day_;
  int joints_;
};

}  // namespace stiffscope::interchange
