#include "core/interchange/length_unit.h"

#include <functional>
#include <map>

#include "core/interchange/delimited_text.h"
#include "core/io/input_error.h"
#include "core/io/units.h"

namespace stiffscope::interchange {

std::optional<double> metresIn(std::string_view unit) {
  constexpr double kInch = 0.0254, kFoot = 0.3048;
  static const std::map<std::string, double, std::less<>> units{{"mm", io::kMillimetre},
                                                                {"millimeter", io::kMillimetre},
                                                                {"millimeters", io::kMillimetre},
                                                                {"millimetre", io::kMillimetre},
                                                                {"millimetres", io::kMillimetre},
                                                                {"cm", 1e-2},
                                                                {"centimeters", 1e-2},
                                                                {"zentimeter", 1e-2},
                                                                {"m", 1.0},
                                                                {"meter", 1.0},
                                                                {"meters", 1.0},
                                                                {"metre", 1.0},
                                                                {"metres", 1.0},
                                                                {"metern", 1.0},
                                                                {"m\xC3\xA8tre", 1.0},
                                                                {"m\xC3\xA8tres", 1.0},
                                                                {"millim\xC3\xA8tres", io::kMillimetre},
                                                                {"metros", 1.0},
                                                                {"mil\xC3\xADmetros", io::kMillimetre},
                                                                {"metri", 1.0},
                                                                {"millimetri", io::kMillimetre},
                                                                {"pulgadas", kInch},
                                                                {"pollici", kInch},
                                                                {"millimetern", io::kMillimetre},
                                                                {"in", kInch},
                                                                {"inch", kInch},
                                                                {"inches", kInch},
                                                                {"in.", kInch},
                                                                {"\"", kInch},
                                                                {"zoll", kInch},
                                                                {"pouces", kInch},
                                                                {"pouce", kInch},
                                                                {"ft", kFoot},
                                                                {"feet", kFoot},
                                                                {"foot", kFoot},
                                                                {"um", io::kMicrometre},
                                                                {"\xC2\xB5m", io::kMicrometre},
                                                                {"\xCE\xBCm", io::kMicrometre},
                                                                {"micron", io::kMicrometre},
                                                                {"microns", io::kMicrometre}};
  const auto found = units.find(lowered(trimmed(unit)));
  return found == units.end() ? std::nullopt : std::optional(found->second);
}

double unitOrMillimetres(const std::string& file, const std::string& stated, std::vector<std::string>& warnings) {
  if (!stated.empty()) {
    const auto unit = metresIn(stated);
    if (!unit) throw io::InputError({"unit"}, stated, "expected mm, m or in");
    return *unit;
  }
  warnings.push_back(
      io::inputMessage({file, 0, ""}, "", "the file states no unit: millimetres are taken (option unit)"));
  return io::kMillimetre;
}

}  // namespace stiffscope::interchange
