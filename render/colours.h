#pragma once

#include <array>
#include <cstdint>

namespace stiffscope::render {

/// An sRGB colour.
struct Colour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;

  friend bool operator==(const Colour&, const Colour&) = default;
};

/// The colours of all pictures. The four of the methods are those of the paper's Fig. 7 (grey, red, blue,
/// green), with lightness L* of 77, 51, 33 and 66, so that they stay apart in a grey print and to the
/// colour-blind.
namespace colours {

inline constexpr Colour kNone{190, 190, 190};  ///< no compensation
inline constexpr Colour kCp{216, 72, 60};      ///< Complete Pose
inline constexpr Colour kPp{28, 74, 150};      ///< Partial Pose
inline constexpr Colour kDpp{72, 178, 104};    ///< Decoupled Partial Pose

inline constexpr Colour kMeasured{206, 60, 48};   ///< measured vectors
inline constexpr Colour kPredicted{28, 74, 150};  ///< predicted vectors
inline constexpr Colour kResidual{20, 170, 120};  ///< measured - predicted

inline constexpr Colour kTarget{38, 40, 46};    ///< reflectors
inline constexpr Colour kWrist{232, 168, 32};   ///< the wrist centre
inline constexpr Colour kLink{214, 218, 225};   ///< the arm between its joints
inline constexpr Colour kJoint{166, 174, 188};  ///< drums along the joint axes

inline constexpr Colour kPaper{255, 255, 255};
inline constexpr Colour kInk{32, 32, 36};
inline constexpr Colour kFaintInk{96, 98, 104};
inline constexpr Colour kAxis{120, 122, 128};
inline constexpr Colour kGrid{226, 228, 232};
inline constexpr Colour kBand{232, 237, 244};  ///< behind points: what is expected

/// Things that are told apart but have no colour of their own (reflectors, directions, nests), in this order:
/// L* of 17, 52, 70 and 36, apart in a grey print and to protan, deutan and tritan readers. After four they come again;
/// marks differ as well.
inline constexpr std::array<Colour, 4> kSeries{{{20, 40, 80}, {213, 80, 0}, {86, 180, 233}, {0, 96, 72}}};

}  // namespace colours

/// The colours of a scene, on light paper or on dark. In each, measured, predicted and residual vectors differ
/// by 14 in lightness L* at least and stay apart for red-, green- and blue-blind eyes (a test).
struct Palette {
  Colour paper, ink, faint_ink, grid;
  Colour measured, predicted, residual;
  Colour target, wrist, link, joint;
};

inline constexpr Palette kLightPalette{colours::kPaper,    colours::kInk,       colours::kFaintInk, colours::kGrid,
                                       colours::kMeasured, colours::kPredicted, colours::kResidual, colours::kTarget,
                                       colours::kWrist,    colours::kLink,      colours::kJoint};

inline constexpr Palette kDarkPalette{{24, 26, 31},   {236, 238, 242}, {166, 170, 180}, {58, 62, 70},
                                      {226, 86, 70},  {118, 172, 255}, {170, 240, 200}, {180, 186, 198},
                                      {232, 168, 32}, {124, 130, 143}, {90, 97, 111}};

}  // namespace stiffscope::render
