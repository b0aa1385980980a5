#include <gtest/gtest.h>

#include <cmath>
#include "core/extended_model/extended_model.h"
#include "reports/text/text.h"
#include "reports/words/numbers.h"

namespace stiffscope {
namespace text_numbers_test {

TEST(UnsignedZero, OnlyWhatRoundsToZeroLosesItsSign) {
  EXPECT_FALSE(std::signbit(reports::unsignedZero(-0.0004, 3)));
  EXPECT_FALSE(std::signbit(reports::unsignedZero(-0.0, 3)));
  EXPECT_EQ(reports::unsignedZero(-0.0006, 3), -0.0006);
  EXPECT_EQ(reports::unsignedZero(0.4, 1), 0.4);
  EXPECT_EQ(reports::unsignedZero(-0.4, 0), 0.0);
  EXPECT_EQ(reports::unsignedZero(0.0005, 3), 0.0005);  // prints as 0.001: the double nearest to it lies above
}

TEST(ImprovedText, MetresAreMicrometresAsInTheRest) {
  extended_model::EffectFit effects;
  effects.added.push_back(
      {effects::Effect::target_motion,
       "P12",
       "",
       100.0,
       true,
       {{"P12 x", "m", -75.75e-6, 1.5e-6}, {"turn about x", "rad", 2e-6, 1e-6}, {"size", "N", 3.0, 1.0}}});
  const std::string text = reports::addedEffectsText(effects);
  EXPECT_NE(text.find("-75.75 +-2.9 um\n"), std::string::npos) << text;
  EXPECT_NE(text.find("2 +-2 urad\n"), std::string::npos) << text;
  EXPECT_NE(text.find("3 +-2 N\n"), std::string::npos) << text;
}

TEST(MicroUnits, AreWrittenBehindNumbersAlone) {
  EXPECT_EQ(reports::microUnits("9.6 um rms, +-2 urad, (um), 0.4\n    um"), "9.6 µm rms, +-2 µrad, (µm), 0.4\n    µm");
  EXPECT_EQ(reports::microUnits("Messung um zehn, size_um, 5 umbra"), "Messung um zehn, size_um, 5 umbra");
}

TEST(PlusMinus, IsOneSignAndColumnsStayUnderEachOther) {
  EXPECT_EQ(reports::plusMinusSigns("5.58 +-0.62"), "5.58 ± 0.62");
  EXPECT_EQ(reports::plusMinusSigns("5.58 +-?  next"), "5.58 ± ?  next");
  EXPECT_EQ(reports::plusMinusSigns("(+- U, 95 %)\nlast"), "(± U, 95 %)\nlast");
  // ± is a column narrower than +- between blanks: what stands right of it stays where it was.
  EXPECT_EQ(reports::plusMinusSigns("  P10     1.2 +- 0.1    x\n"), "  P10      1.2 ± 0.1    x\n");
  EXPECT_EQ(reports::plusMinusSigns("a+-b, C+-"), "a+-b, C+-");
}

TEST(Lengths, AreInTheUnitThatSuitsTheirSize) {
  EXPECT_EQ(reports::lengthWords(58048.7e-6, 1), "58.05 mm");
  EXPECT_EQ(reports::lengthWords(312.34e-3, 1), "312.3 mm");
  EXPECT_EQ(reports::lengthWords(999.4e-6, 1), "999.4 um");
  EXPECT_EQ(reports::lengthWords(999.97e-6, 1), "1.00 mm");  // not 1000.0 um
  EXPECT_EQ(reports::lengthWords(0.0, 0), "0 um");
  EXPECT_EQ(reports::shownLength(12.6e-6, 2), "13\u00a0µm");
  EXPECT_EQ(reports::shownLength(51.9e-3, 2), "52\u00a0mm");
  EXPECT_STREQ(reports::lengthUnit(std::nan("")).name, "µm");
}

TEST(StiffnessUnit, SuitsTheSmallestJoint) {
  EXPECT_EQ(reports::stiffnessUnit(std::vector<double>{5.6e6, 78e3}).size, 1e6);    // a large robot
  EXPECT_EQ(reports::stiffnessUnit(std::vector<double>{1.2e5, 6100.0}).size, 1e3);  // a small one's wrist
  EXPECT_EQ(reports::stiffnessUnit(std::vector<double>{500.0, 4.0}).size, 1.0);
  EXPECT_EQ(reports::stiffnessUnit(std::vector<double>{}).size, 1e6);
}

}  // namespace text_numbers_test
}  // namespace stiffscope
