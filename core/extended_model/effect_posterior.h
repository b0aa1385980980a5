#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace stiffscope::extended_model {

/// What the data say of all effects' parameters together, stiffnesses and geometry fitted away: chi2(x) = x^T N x
/// - 2 b^T x + const, x in units of the parameters' physical bounds (effect_model.h).
struct EffectEvidence {
  Eigen::MatrixXd normal;          ///< N, n x n, positive semidefinite
  Eigen::VectorXd right;           ///< b, n
  std::vector<std::size_t> group;  ///< the effect of each parameter, 0, 1, ...
  std::vector<bool> positive;      ///< a compliance, a width: never negative
  std::vector<double> known_sd;    ///< of each parameter beforehand, where that is declared; 0 or absent: it is not
};

struct PosteriorOptions {
  int draws = 600, warm_up = 150;
  std::uint64_t seed = 1;
};

/// Draws from the posterior of x: n rows, a draw each column.
///
/// Prior: the horseshoe (Carvalho, Polson and Scott, Biometrika 97, 2010, 465), x_i ~ N(0, l_i^2 t_g^2) with l_i ~
/// C+(0, 1) for the parameter and t_g ~ C+(0, kUsual) for its effect g; x_i > 0 where that is physics. Most effects of
/// a machine are too small to matter and some are large: this prior says just that. Where the data do not see a
/// parameter it stays as small as its effect's others; where they see it, the heavy tails leave it as it is. The
/// prior of a parameter that is declared with a standard uncertainty is normal with that.
///
/// By Gibbs sampling: the parameters of either sign jointly, those that are positive one after the other with the
/// former integrated out, the scales by their inverse gamma mixtures (Makalic and Schmidt, IEEE Signal Processing
/// Letters 23, 2016, 179). The same seed gives the same draws.
Eigen::MatrixXd drawEffects(const EffectEvidence& evidence, const PosteriorOptions& options = {});

/// Scale of an effect's size before anything is measured, as a share of the physical bounds. From a third to three
/// times it, intervals hold the truth as often.
inline constexpr double kUsual = 0.03;

}  // namespace stiffscope::extended_model
