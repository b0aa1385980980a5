#include "python/to_python.h"

#include <pybind11/numpy.h>
#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/numerics/parallel.h"

namespace py = pybind11;

namespace stiffscope::python {

namespace {

using reports::Json;
using Place = Json::json_pointer;

enum class Holds { nothing, truth, whole, real };

/// What a JSON value is as an array. `open`: null, which takes the shape of its neighbours.
struct Shape {
  std::vector<py::ssize_t> sizes;
  Holds holds = Holds::nothing;
  bool open = false, has_null = false;
};

/// Whether both may stand in one array; `a` then holds what both need.
bool unite(Shape& a, const Shape& b) {
  a.has_null = a.has_null || b.has_null;
  if (b.open) return true;
  if (a.open) {
    const bool has_null = a.has_null;
    a = b;
    a.has_null = has_null;
    return true;
  }
  if (a.sizes != b.sizes || (a.holds == Holds::truth) != (b.holds == Holds::truth)) return false;
  a.holds = std::max(a.holds, b.holds);
  return true;
}

std::optional<Shape> shapeOf(const Json& value) {
  Shape shape;
  if (value.is_null()) {
    shape.open = shape.has_null = true;
    return shape;
  }
  if (value.is_boolean()) shape.holds = Holds::truth;
  if (value.is_number()) shape.holds = value.is_number_float() ? Holds::real : Holds::whole;
  if (shape.holds != Holds::nothing) return shape;
  if (!value.is_array() || value.empty()) return std::nullopt;
  Shape inner;
  inner.open = true;
  for (const Json& element : value) {
    const std::optional<Shape> one = shapeOf(element);
    if (!one || !unite(inner, *one)) return std::nullopt;
  }
  if (inner.open) inner.holds = Holds::real;  // nothing but null
  inner.open = false;
  inner.sizes.insert(inner.sizes.begin(), static_cast<py::ssize_t>(value.size()));
  return inner;
}

/// Fills what belongs to `value` of an array whose `depth` outer dimensions are settled.
template <class Number>
void fill(const Json& value, const std::vector<py::ssize_t>& sizes, std::size_t depth, Number*& to) {
  if (value.is_null()) {
    py::ssize_t count = 1;
    for (std::size_t i = depth; i < sizes.size(); ++i) count *= sizes[i];
    if constexpr (std::numeric_limits<Number>::has_quiet_NaN)
      to = std::fill_n(to, count, std::numeric_limits<Number>::quiet_NaN());
    return;
  }
  if (depth == sizes.size()) {
    *to++ = value.get<Number>();
    return;
  }
  for (const Json& element : value) fill(element, sizes, depth + 1, to);
}

template <class Number>
py::array arrayOf(const Json& value, const Shape& shape) {
  py::array_t<Number> array(shape.sizes);
  Number* to = array.mutable_data();
  fill(value, shape.sizes, 0, to);
  return std::move(array);
}

/// Makes Python's objects; all of it with the GIL.
class Maker {
 public:
  Maker() {
    const py::module_ results = py::module_::import("stiffscope._results");
    record_ = results.attr("Record");
    rows_ = results.attr("Rows");
  }

  py::object record() const { return record_(); }
  py::list rows() const { return rows_(); }

  /// Keys come by the thousand, the same ones again.
  const py::str& key(const std::string& name) {
    const auto known = keys_.find(name);
    return known != keys_.end() ? known->second : keys_.emplace(name, py::str(name)).first->second;
  }

  py::object make(const Json& value) {
    switch (value.type()) {
      case Json::value_t::object: {
        py::object made = record();
        for (const auto& [name, inner] : value.items()) put(made, name, make(inner));
        return made;
      }
      case Json::value_t::array:
        return list(value);
      case Json::value_t::string:
        return py::str(value.get_ref<const std::string&>());
      case Json::value_t::boolean:
        return py::bool_(value.get<bool>());
      case Json::value_t::number_integer:
        return py::int_(value.get<std::int64_t>());
      case Json::value_t::number_unsigned:
        return py::int_(value.get<std::uint64_t>());
      case Json::value_t::number_float:
        return py::float_(value.get<double>());
      default:
        return py::none();
    }
  }

  void put(py::object& record, const std::string& name, const py::object& value) {
    if (PyDict_SetItem(record.ptr(), key(name).ptr(), value.ptr()) != 0) throw py::error_already_set();
  }

 private:
  py::object list(const Json& value) {
    if (const std::optional<Shape> shape = shapeOf(value)) {
      if (shape->holds == Holds::real || (shape->holds == Holds::whole && shape->has_null))
        return arrayOf<double>(value, *shape);
      if (shape->holds == Holds::whole) return arrayOf<std::int64_t>(value, *shape);
      if (!shape->has_null) return arrayOf<bool>(value, *shape);
    }
    const bool objects =
        std::all_of(value.begin(), value.end(), [](const Json& one) { return one.is_object() || one.is_null(); });
    py::list made = objects ? rows() : py::list();
    for (const Json& element : value) made.append(make(element));
    return made;
  }

  py::object record_, rows_;
  std::unordered_map<std::string, py::str> keys_;
};

/// A list that the document has not made yet.
py::object madeRows(const reports::JsonRows& rows, Maker& maker) {
  constexpr std::size_t kTogether = 2048;
  py::list made = maker.rows();
  std::vector<Json> block;
  for (std::size_t from = 0; from < rows.count; from += kTogether) {
    block.assign(std::min(kTogether, rows.count - from), nullptr);
    {
      const py::gil_scoped_release others_run;
      numerics::onAllCores(block.size(), [&](std::size_t i) { block[i] = rows.row(from + i); });
    }
    for (const Json& row : block) made.append(maker.make(row));
  }
  return std::move(made);
}

py::object made(const reports::JsonDocument& document, const Json& value, const Place& place, Maker& maker) {
  if (const reports::JsonRows* rows = document.rowsAt(place)) return madeRows(*rows, maker);
  if (!value.is_object()) return maker.make(value);
  py::object record = maker.record();
  for (const auto& [name, inner] : value.items()) maker.put(record, name, made(document, inner, place / name, maker));
  return record;
}

}  // namespace

py::object toPython(const reports::JsonDocument& document) {
  const py::gil_scoped_acquire gil;
  Maker maker;
  return made(document, document.json, Place(), maker);
}

}  // namespace stiffscope::python
