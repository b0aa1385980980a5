#pragma once
#ifdef STIFFSCOPE_TEST_MUJOCO
#include <mujoco/mujoco.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "core/robot/robot.h"

namespace stiffscope {

/// A force (N) and moment (Nm) about a point, world axes.
struct MujocoLoad {
  Eigen::Vector3d force, moment;
};

/// An exported arm as MuJoCo reads it, at rest: kinematics, weights, springs and the load's generalised forces are all
/// MuJoCo's; only the balance is found here.
class MujocoArm {
 public:
  explicit MujocoArm(const std::string& xml) {
    const auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    mj_makeEmptyFileVFS(files.get(), "arm.xml", static_cast<int>(xml.size()));
    std::memcpy(files->filedata[0], xml.data(), xml.size());
    std::array<char, 1000> error{};
    model_.reset(mj_loadXML("arm.xml", files.get(), error.data(), static_cast<int>(error.size())));
    mj_deleteVFS(files.get());
    if (!model_) throw std::runtime_error(error.data());
    data_.reset(mj_makeData(model_.get()));
  }

  mjModel& model() { return *model_; }
  mjData& data() { return *data_; }

  int joint(const std::string& name) const { return idOf(mjOBJ_JOINT, name); }
  int site(const std::string& name) const { return idOf(mjOBJ_SITE, name); }

  /// Angles of the drives, springs unloaded.
  void stand(const PerJoint<std::string>& drives, const JointVector& q) {
    mj_resetData(model_.get(), data_.get());
    for (std::size_t j = 0; j < drives.size(); ++j)
      data_->qpos[model_->jnt_qposadr[joint(drives[j])]] = q[static_cast<Eigen::Index>(j)];
    mj_fwdPosition(model_.get(), data_.get());
  }

  /// Brings the springs into balance with weight and load, which acts at site `at`: s += r / k, r what MuJoCo leaves of
  /// the generalised force. Contracts a hundredfold a step. False where it does not settle.
  bool settle(const std::string& at = {}, const MujocoLoad& load = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}) {
    constexpr int kMostSteps = 60;
    constexpr double kSettled = 1e-14;  // rad and m
    mjModel* const m = model_.get();
    mjData* const d = data_.get();
    Eigen::VectorXd& applied = applied_;
    for (int step = 0; step < kMostSteps; ++step) {
      mj_fwdPosition(m, d);
      mj_fwdVelocity(m, d);
      applied.setZero(m->nv);
      if (!at.empty()) {
        const int place = site(at);
        mj_applyFT(m, d, load.force.data(), load.moment.data(), d->site_xpos + 3 * place, m->site_bodyid[place],
                   applied.data());
      }
      double largest = 0.0;
      for (int j = 0; j < m->njnt; ++j) {
        if (m->jnt_stiffness[j] <= 0.0) continue;
        const int dof = m->jnt_dofadr[j];
        const double change = (d->qfrc_passive[dof] - d->qfrc_bias[dof] + applied[dof]) / m->jnt_stiffness[j];
        d->qpos[m->jnt_qposadr[j]] += change;
        largest = std::max(largest, std::abs(change));
      }
      if (largest < kSettled) {
        mj_fwdPosition(m, d);
        return true;
      }
    }
    return false;
  }

  // Of a joint, settled.
  double position(const std::string& name) const { return data_->qpos[model_->jnt_qposadr[joint(name)]]; }
  Eigen::Vector3d axis(const std::string& name) const {
    return Eigen::Map<const Eigen::Vector3d>(data_->xaxis + 3 * joint(name));
  }
  Eigen::Vector3d anchor(const std::string& name) const {
    return Eigen::Map<const Eigen::Vector3d>(data_->xanchor + 3 * joint(name));
  }
  /// What weight and load do on it, N m.
  double torque(const std::string& name) const {
    const int dof = model_->jnt_dofadr[joint(name)];
    return applied_[dof] - data_->qfrc_bias[dof];
  }

  Eigen::Vector3d place(const std::string& name) const {
    return Eigen::Map<const Eigen::Vector3d>(data_->site_xpos + 3 * site(name));
  }
  Eigen::Matrix3d axes(const std::string& name) const {
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(data_->site_xmat + 9 * site(name));
  }

 private:
  struct Free {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };

  int idOf(int type, const std::string& name) const {
    const int id = mj_name2id(model_.get(), type, name.c_str());
    if (id < 0) throw std::runtime_error("the model has no " + name);
    return id;
  }

  std::unique_ptr<mjModel, Free> model_;
  std::unique_ptr<mjData, Free> data_;
  Eigen::VectorXd applied_;
};

}  // namespace stiffscope
#endif
