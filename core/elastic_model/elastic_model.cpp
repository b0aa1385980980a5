#include "core/elastic_model/elastic_model.h"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <optional>
#include <set>

#include "core/effects/all.h"
#include "core/robot/body_inertia.h"
#include "metrology/lines.h"

namespace stiffscope::elastic_model {

namespace {

/// Sizes of an effect, none where it is not in the model.
struct SizesOf {
  const effects::PresentEffect* effect = nullptr;

  SizesOf(const std::vector<effects::PresentEffect>& all, effects::Effect wanted) {
    for (const effects::PresentEffect& one : all) {
      if (one.model->effect == wanted) effect = &one;
    }
  }
  double at(Eigen::Index place) const { return effect ? effect->parameters[place] : 0.0; }
};

/// The inertia as simulators take it, principal moments above 0 and none more than the other two together, that bound
/// kept clear of rounding; empty where no rigid body has it.
std::optional<Eigen::Matrix3d> inertiaOfABody(const Eigen::Matrix3d& inertia) {
  constexpr double kLeast = 1e-12, kRounding = 1e-9;
  const Eigen::Vector3d moments = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(inertia).eigenvalues();
  const double both = moments[0] + moments[1];
  if (!(moments[0] > kLeast) || moments[2] > both * (1.0 + kRounding)) return std::nullopt;
  if (moments[2] < both * (1.0 - kRounding)) return inertia;
  return inertia + 2.0 * kRounding * moments[2] * Eigen::Matrix3d::Identity();  // a thin plate
}

class ChainBuilder {
 public:
  explicit ChainBuilder(const ElasticSource& source)
      : source_(source),
        base_from_r0_(source.geometry.r0_from_base_link.inverse()),
        arm_(source.geometry.arm),
        last_(arm_.axes_in_base_at_zero.size()),
        body_of_link_(last_ + 1, 0) {}

  ElasticModel build() {
    ElasticChain& chain = model_.chain;
    chain.name = ownName(source_.campaign.robot.name.empty() ? "arm" : source_.campaign.robot.name);
    chain.base = ownName(source_.campaign.base_link);
    chain.gravity = source_.campaign.gravity_in_base;
    addBase();
    for (std::size_t joint = 0; joint < last_; ++joint) {
      if (joint > 0) addBeam(joint - 1);
      addJoint(joint);
    }
    addPlate();
    placeMasses();
    addSites();
    remarkOnEffects();
    return std::move(model_);
  }

 private:
  /// A name that nothing else in the chain has: some formats keep bodies, joints and frames in one list.
  std::string ownName(std::string name) {
    for (std::size_t at = name.find("::"); at != std::string::npos; at = name.find("::")) name.replace(at, 2, "_");
    if (name.empty() || name == "world") name += "_";
    while (!names_.insert(name).second) name += "_";
    return name;
  }

  ChainBody bodyNamed(const std::string& name, const Eigen::Vector3d& origin) {
    return {ownName(name), origin, {}, {}};
  }

  /// A spring of this compliance; none where that is not positive.
  void addSpring(ChainBody& body, ChainJoint::Kind kind, const std::string& name, const Eigen::Vector3d& direction,
                 double compliance) {
    if (!(compliance > 0.0)) return;
    body.joints.push_back({.name = ownName(name),
                           .kind = kind,
                           .point = body.origin,
                           .direction = direction,
                           .stiffness = 1.0 / compliance});
  }
  void addTurn(ChainBody& body, const std::string& name, const Eigen::Vector3d& direction, double compliance) {
    addSpring(body, ChainJoint::Kind::turn_spring, name, direction, compliance);
  }
  void addShift(ChainBody& body, const std::string& name, const Eigen::Vector3d& direction, double compliance) {
    addSpring(body, ChainJoint::Kind::shift_spring, name, direction, compliance);
  }

  void addIfElastic(ChainBody body) {
    if (!body.joints.empty()) model_.chain.bodies.push_back(std::move(body));
  }

  metrology::Line axis(std::size_t joint) const {
    const metrology::Line& in_r0 = arm_.axes_in_base_at_zero[joint];
    return {base_from_r0_ * in_r0.point, base_from_r0_.linear() * in_r0.direction};
  }

  /// The link that joint `body` - 1 carries, as the URDF calls it.
  std::string linkName(int body) const {
    const auto& links = source_.campaign.robot.links;
    const auto found = std::find_if(links.begin(), links.end(), [&](const auto& link) { return link.body == body; });
    return found == links.end() ? fmt::format("link_{}", body) : found->name;
  }

  void addBase() {
    const SizesOf base(source_.effects, effects::Effect::base_compliance);
    const std::optional<robot::Rail>& rail = source_.campaign.robot.rail;
    const Eigen::Matrix3d foot =
        effects::footAxes(rail ? rail->direction_in_base : Eigen::Vector3d(Eigen::Vector3d::Zero()));
    ChainBody body = bodyNamed("base_flexure", Eigen::Vector3d::Zero());
    const char* const along[] = {"x", "y", "z"};
    for (int k = 0; k < 3; ++k) addShift(body, fmt::format("base_shift_{}", along[k]), foot.col(k), base.at(2 + k));
    for (int k = 0; k < 2; ++k) addTurn(body, fmt::format("base_rocking_{}", along[k]), foot.col(k), base.at(k));
    addIfElastic(std::move(body));
  }

  /// Of the link that `joint` carries, at the middle of its beam.
  void addBeam(std::size_t joint) {
    const SizesOf beams(source_.effects, effects::Effect::link_compliance);
    if (beams.effect == nullptr) return;
    const auto own = static_cast<Eigen::Index>(2 * joint);
    if (own + 1 >= beams.effect->parameters.size()) return;  // a link that the effect takes as rigid
    const Eigen::Vector3d from = axis(joint).point, to = axis(joint + 1).point;
    const double length = (to - from).norm();
    constexpr double kNoBeam = 0.05;  // m: as the effect has it
    if (length < kNoBeam) return;
    const double bending = beams.at(own), torsion = beams.at(own + 1);
    const Eigen::Vector3d along = (to - from) / length;
    Eigen::Vector3d u, v;
    metrology::basisAcross(along, u, v);
    const std::string link = linkName(static_cast<int>(joint) + 1);
    ChainBody body = bodyNamed(link + "_flexure", 0.5 * (from + to));
    addShift(body, link + "_bending_shift_u", u, bending * length * length * length / 12.0);
    addShift(body, link + "_bending_shift_v", v, bending * length * length * length / 12.0);
    addTurn(body, link + "_bending_u", u, bending * length);
    addTurn(body, link + "_bending_v", v, bending * length);
    addTurn(body, link + "_torsion", along, torsion * length);
    addIfElastic(std::move(body));
  }

  double usableCompliance(std::size_t joint) {
    const auto j = static_cast<Eigen::Index>(joint);
    const identification::StiffnessEstimate& estimate = source_.estimate;
    if (!estimate.identifiable[joint]) {
      model_.remarks.emplace_back(RemarkId::rigid_not_identifiable, joint + 1);
      return 0.0;
    }
    if (!(estimate.compliance[j] > 0.0)) {
      model_.remarks.emplace_back(RemarkId::rigid_negative, joint + 1, estimate.stiffness(static_cast<int>(joint)));
      return 0.0;
    }
    return estimate.compliance[j];
  }

  void addJoint(std::size_t joint) {
    const metrology::Line line = axis(joint);
    const std::string& name = source_.campaign.robot.joint_names[joint];
    const robot::JointLimits& limits = source_.campaign.robot.limits[joint];
    const ChainJoint drive{.name = ownName(name),
                           .kind = ChainJoint::Kind::drive,
                           .point = line.point,
                           .direction = line.direction,
                           .lower = limits.lower,
                           .upper = limits.upper};
    ChainBody link = bodyNamed(linkName(static_cast<int>(joint) + 1), line.point);
    const double tilt = SizesOf(source_.effects, effects::Effect::bearing_tilt).at(static_cast<Eigen::Index>(joint));
    Eigen::Vector3d u, v;
    metrology::basisAcross(line.direction, u, v);
    addTurn(link, name + "_spring", line.direction, usableCompliance(joint));
    addTurn(link, name + "_tilt_u", u, tilt);
    addTurn(link, name + "_tilt_v", v, tilt);
    if (link.joints.empty()) {
      link.joints.push_back(drive);
    } else {
      ChainBody driven = bodyNamed(name + "_drive", line.point);
      driven.joints.push_back(drive);
      model_.chain.bodies.push_back(std::move(driven));
    }
    body_of_link_[joint + 1] = static_cast<int>(model_.chain.bodies.size());
    model_.chain.bodies.push_back(std::move(link));
  }

  void addPlate() {
    const SizesOf plate(source_.effects, effects::Effect::tool_compliance);
    const Eigen::Isometry3d flange = base_from_r0_ * arm_.base_from_flange_at_zero;
    ChainBody body = bodyNamed("tool_flexure", flange.translation());
    const char* const along[] = {"x", "y", "z"};
    for (int k = 0; k < 3; ++k)
      addShift(body, fmt::format("tool_shift_{}", along[k]), flange.linear().col(k), plate.at(3 + k));
    const char* const about[] = {"tool_bending_x", "tool_bending_y", "tool_twist_z"};
    for (int k = 0; k < 3; ++k) addTurn(body, about[k], flange.linear().col(k), plate.at(k));
    tool_body_ = body_of_link_.back();
    if (body.joints.empty()) return;
    // The effect's first equation has all of the last body hang on the plate, its second one nothing.
    if (plate.effect->model->shape != "by the load alone")
      body_of_link_.back() = static_cast<int>(model_.chain.bodies.size());
    tool_body_ = static_cast<int>(model_.chain.bodies.size());
    model_.chain.bodies.push_back(std::move(body));
  }

  ChainMass massOf(std::size_t body) const {
    const robot::BodyMass& weight = source_.geometry.weight.bodies[body];
    ChainMass mass{weight.mass_kg, base_from_r0_ * weight.com_in_base_at_zero};
    if (!source_.inertias.empty()) mass.inertia = source_.inertias[body];
    const robot::BodyMass& links = source_.campaign.robot.bodies[body];
    const double tool_kg = weight.mass_kg - links.mass_kg;
    if (tool_kg <= 0.0) return mass;
    const Eigen::Vector3d tool =
        (weight.mass_kg * mass.centre - links.mass_kg * links.com_in_base_at_zero) / tool_kg;  // the tool's centre
    mass.inertia += robot::pointMassInertia(tool_kg, tool - mass.centre);
    if (links.mass_kg > 0.0)
      mass.inertia += robot::pointMassInertia(links.mass_kg, links.com_in_base_at_zero - mass.centre);
    return mass;
  }

  void placeMasses() {
    const robot::GravityLoad& weight = source_.geometry.weight;
    if (!weight.links_known) model_.remarks.emplace_back(RemarkId::no_masses);
    std::vector<std::string> stand_in;
    for (std::size_t body = 1; body <= last_; ++body) {
      if (!weight.links_known || weight.bodies[body].mass_kg <= 0.0) continue;
      ChainBody& own = model_.chain.bodies[static_cast<std::size_t>(body_of_link_[body])];
      own.mass = massOf(body);
      const std::optional<Eigen::Matrix3d> physical = inertiaOfABody(own.mass.inertia);
      own.mass.inertia = physical.value_or(kStandInInertia * Eigen::Matrix3d::Identity());
      if (!physical) stand_in.push_back(own.name);
    }
    if (!weight.balancers.empty())
      model_.remarks.emplace_back(RemarkId::no_balancers, static_cast<int>(weight.balancers.size()));
    if (!stand_in.empty()) model_.remarks.emplace_back(RemarkId::no_inertia, stand_in);
  }

  void addSite(const std::string& name, int body, const Eigen::Isometry3d& r0_from_site) {
    model_.chain.sites.push_back({ownName(name), body, base_from_r0_ * r0_from_site});
  }

  void addSites() {
    addSite("R0", -1, Eigen::Isometry3d::Identity());
    const Eigen::Isometry3d& flange = arm_.base_from_flange_at_zero;
    const auto pointOf = [](const Eigen::Vector3d& point, const Eigen::Matrix3d& axes) {
      Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
      place.linear() = axes;
      place.translation() = point;
      return place;
    };
    addSite(source_.campaign.flange_link, tool_body_, flange);
    addSite("tcp", tool_body_, pointOf(flange * source_.tcp_in_flange, flange.linear()));
    addLoadPoint();
    for (std::size_t t = 0; t < source_.campaign.targets.size(); ++t) {
      const auto& place = source_.geometry.targets_at_zero[t];
      if (place) addSite(source_.campaign.targets[t].id, tool_body_, pointOf(*place, flange.linear()));
    }
  }

  const robot::LinkFrame* linkNamed(const std::string& name) const {
    const auto found =
        std::find_if(arm_.links.begin(), arm_.links.end(), [&](const auto& link) { return link.name == name; });
    return found == arm_.links.end() ? nullptr : &*found;
  }

  int chainBodyOf(const robot::LinkFrame& link) const {
    const auto body = static_cast<std::size_t>(link.body);
    return body == last_ ? tool_body_ : body == 0 ? -1 : body_of_link_[body];
  }

  void addLoadPoint() {
    if (!source_.campaign.load_cell) return;
    const campaign::LoadCell& cell = *source_.campaign.load_cell;
    const robot::LinkFrame* parent = linkNamed(cell.parent);
    if (parent == nullptr) return;
    Eigen::Isometry3d place = parent->base_from_link_at_zero * cell.parent_from_cell;
    const robot::LinkFrame* axes = cell.axes_link ? linkNamed(*cell.axes_link) : nullptr;
    if (axes != nullptr && axes->body == parent->body) place.linear() = axes->base_from_link_at_zero.linear();
    if (axes != nullptr && axes->body != parent->body)
      model_.remarks.emplace_back(RemarkId::load_axes_turn_with_link, *cell.axes_link);
    addSite("load_point", chainBodyOf(*parent), place);
  }

  void remarkOnEffects() {
    using enum effects::Effect;
    const auto isSpring = [](effects::Effect effect) {
      return effect == bearing_tilt || effect == link_compliance || effect == base_compliance ||
             effect == tool_compliance;
    };
    std::set<effects::Effect> all(source_.added.begin(), source_.added.end());
    for (const effects::PresentEffect& one : source_.effects) all.insert(one.model->effect);
    for (const effects::Effect effect : all) {
      const std::string id(effects::idOf(effect));
      switch (effects::natureOf(effect)) {
        case effects::EffectNature::machine:
          if (!isSpring(effect)) model_.remarks.emplace_back(RemarkId::effect_of_no_spring, id);
          break;
        case effects::EffectNature::load:
          model_.remarks.emplace_back(RemarkId::effect_in_load_point, id);
          break;
        case effects::EffectNature::measurement:
          model_.remarks.emplace_back(RemarkId::effect_of_measurement, id);
          break;
        case effects::EffectNature::geometry:
          break;  // every identification has the measured one
      }
    }
  }

  const ElasticSource& source_;
  Eigen::Isometry3d base_from_r0_;
  const robot::Robot& arm_;
  std::size_t last_;  // body: as many as joints
  ElasticModel model_;
  std::set<std::string> names_;
  PerBody<int> body_of_link_;  // that bears the mass of the robot's body
  int tool_body_ = -1;         // that reflectors and load are on
};

}  // namespace

ElasticModel elasticModel(const ElasticSource& source) { return ChainBuilder(source).build(); }

}  // namespace stiffscope::elastic_model
