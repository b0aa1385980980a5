#include "render/vtk/arm_shape.h"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkUnsignedCharArray.h>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "render/ticks.h"
#include "render/vtk/chart_frame.h"

namespace stiffscope::render {

namespace {

constexpr int kSides = 40;

}  // namespace

int Mesh::addVertex(const Eigen::Vector3d& point, const Eigen::Vector3d& normal, Colour colour) {
  const double light = ambient_ + (1.06 - ambient_) * std::max(0.0, normal.dot(light_));
  for (int i = 0; i < 3; ++i) points_.push_back(static_cast<float>(point[i]));
  for (const std::uint8_t channel : {colour.red, colour.green, colour.blue}) {
    colours_.push_back(static_cast<std::uint8_t>(std::min(255.0, std::round(channel * light))));
  }
  return static_cast<int>(points_.size() / 3) - 1;
}

void Mesh::addQuad(int a, int b, int c, int d) { triangles_.insert(triangles_.end(), {a, b, c, a, c, d}); }

void Mesh::addCone(const Eigen::Vector3d& from, double from_radius, const Eigen::Vector3d& to, double to_radius,
                   Colour colour) {
  const double length = (to - from).norm();
  if (!(length > 1e-9)) return;
  const Eigen::Vector3d axis = (to - from) / length;
  const Eigen::Vector3d u = axis.unitOrthogonal();
  const Eigen::Vector3d v = axis.cross(u);
  const double slope = (from_radius - to_radius) / length;
  const int from_centre = addVertex(from, -axis, colour);
  const int to_centre = addVertex(to, axis, colour);
  const int first = to_centre + 1;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * M_PI * i / kSides;
    const Eigen::Vector3d radial = std::cos(angle) * u + std::sin(angle) * v;
    const Eigen::Vector3d normal = (radial + slope * axis).normalized();
    addVertex(from + from_radius * radial, normal, colour);
    addVertex(to + to_radius * radial, normal, colour);
    addVertex(from + from_radius * radial, -axis, colour);
    addVertex(to + to_radius * radial, axis, colour);
  }
  for (int i = 0; i < kSides; ++i) {
    const int a = first + 4 * i;
    const int b = first + 4 * ((i + 1) % kSides);
    addQuad(a, b, b + 1, a + 1);
    triangles_.insert(triangles_.end(), {from_centre, b + 2, a + 2, to_centre, a + 3, b + 3});
  }
}

void Mesh::addSphere(const Eigen::Vector3d& centre, double radius, Colour colour) {
  addSphere(centre, radius, colour, kSides);
}

void Mesh::addDot(const Eigen::Vector3d& centre, double radius, Colour colour) { addSphere(centre, radius, colour, 8); }

void Mesh::addSphere(const Eigen::Vector3d& centre, double radius, Colour colour, int sides) {
  const int rings = sides / 2;
  const int first = static_cast<int>(points_.size() / 3);
  for (int ring = 0; ring <= rings; ++ring) {
    const double latitude = M_PI * ring / rings;
    for (int i = 0; i < sides; ++i) {
      const double angle = 2 * M_PI * i / sides;
      const Eigen::Vector3d normal(std::sin(latitude) * std::cos(angle), std::sin(latitude) * std::sin(angle),
                                   std::cos(latitude));
      addVertex(centre + radius * normal, normal, colour);
    }
  }
  for (int ring = 0; ring < rings; ++ring) {
    for (int i = 0; i < sides; ++i) {
      const int a = first + sides * ring + i;
      const int b = first + sides * ring + (i + 1) % sides;
      addQuad(a, a + sides, b + sides, b);
    }
  }
}

void Mesh::addArrow(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius, double head_length,
                    Colour colour) {
  const double length = (to - from).norm();
  if (!(length > 1e-9)) return;
  const double head = std::min(head_length, 0.6 * length);
  const Eigen::Vector3d neck = to - head * (to - from) / length;
  addCone(from, radius, neck, radius, colour);
  addCone(neck, std::max(0.4 * head, 1.4 * radius), to, 0, colour);
}

vtkSmartPointer<vtkActor> Mesh::actor() const {
  const vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  points->SetNumberOfPoints(static_cast<vtkIdType>(points_.size() / 3));
  std::copy(points_.begin(), points_.end(), static_cast<float*>(points->GetVoidPointer(0)));
  // A hundred arms are a million triangles: no more room than they take, which VTK would double and double again.
  const vtkNew<vtkCellArray> triangles;
  triangles->Use32BitStorage();
  triangles->AllocateExact(static_cast<vtkIdType>(triangles_.size() / 3), static_cast<vtkIdType>(triangles_.size()));
  for (std::size_t i = 0; i < triangles_.size(); i += 3) {
    triangles->InsertNextCell({triangles_[i], triangles_[i + 1], triangles_[i + 2]});
  }
  const vtkNew<vtkUnsignedCharArray> colours;
  colours->SetNumberOfComponents(3);
  colours->SetNumberOfTuples(static_cast<vtkIdType>(colours_.size() / 3));
  std::copy(colours_.begin(), colours_.end(), colours->GetPointer(0));

  const vtkNew<vtkPolyData> surface;
  surface->SetPoints(points);
  surface->SetPolys(triangles);
  surface->GetPointData()->SetScalars(colours);
  const vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(surface);
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->LightingOff();
  actor->GetProperty()->BackfaceCullingOn();
  return actor;
}

ArmProportions::ArmProportions(const ArmPose& pose) {
  for (std::size_t i = 1; i < pose.joint_points.size(); ++i) {
    length += (pose.joint_points[i] - pose.joint_points[i - 1]).norm();
  }
  base_radius = 0.042 * length;
  tip_radius = 0.018 * length;
  target_radius = 0.6 * tip_radius;
}

namespace {

struct Paint {
  Colour link, joint, target;
};

void addPedestal(Mesh& mesh, const Eigen::Vector3d& first_joint, double radius, Colour colour) {
  const Eigen::Vector3d foot(first_joint.x(), first_joint.y(), std::min(0.0, first_joint.z()));
  const Eigen::Vector3d plate = foot + Eigen::Vector3d(0, 0, 0.35 * radius);
  mesh.addCone(foot, 2.1 * radius, plate, 2.1 * radius, colour);
  if (first_joint.z() > plate.z()) mesh.addCone(plate, 1.7 * radius, first_joint, 1.5 * radius, colour);
}

void addDrum(Mesh& mesh, const Eigen::Vector3d& joint, const Eigen::Vector3d& axis, double radius, Colour colour) {
  const Eigen::Vector3d half = 1.35 * radius * axis.normalized();
  mesh.addCone(joint - half, 1.28 * radius, joint + half, 1.28 * radius, colour);
}

// The waist stands upon the pedestal: up the first axis as far as the shoulder, then across to it.
void addWaist(Mesh& mesh, const ArmPose& pose, double radius, double next, const Paint& paint) {
  const Eigen::Vector3d& foot = pose.joint_points[0];
  const Eigen::Vector3d& shoulder = pose.joint_points[1];
  const Eigen::Vector3d axis = pose.axis_directions[0].normalized();
  const Eigen::Vector3d corner = foot + axis.dot(shoulder - foot) * axis;
  mesh.addCone(foot, 1.45 * radius, foot + std::min(0.25, 0.6 * radius) * axis, 1.45 * radius, paint.joint);
  mesh.addCone(foot, 1.2 * radius, corner, 1.05 * radius, paint.link);
  mesh.addSphere(corner, 1.05 * radius, paint.link);
  mesh.addCone(corner, 1.05 * radius, shoulder, next, paint.link);
}

void addFlange(Mesh& mesh, const ArmPose& pose, const ArmProportions& proportions, const Paint& paint) {
  const double radius = proportions.tip_radius;
  const Eigen::Vector3d& flange = pose.joint_points.back();
  const Eigen::Vector3d axis = pose.axis_directions.back().normalized();
  // It faces away from the arm, whichever way its axis was counted.
  const double side = axis.dot(flange - pose.joint_points[pose.joint_points.size() - 2]) < 0 ? -1 : 1;
  mesh.addCone(flange - 0.6 * side * radius * axis, 1.7 * radius, flange, 1.7 * radius, paint.joint);
  for (const ScenePoint& target : pose.targets) {
    mesh.addCone(flange, 0.25 * radius, target.position, 0.25 * radius, paint.joint);
    mesh.addSphere(target.position, proportions.target_radius, paint.target);
  }
}

}  // namespace

double ArmProportions::radiusAt(double along) const {
  return std::lerp(base_radius, tip_radius, length > 0 ? along / length : 0);
}

bool drawsLoad(const ArmPose& pose) { return !pose.ghost && pose.load && pose.load->force.norm() > 0.0; }

Eigen::Vector3d loadTip(const ArmPose& pose) {
  constexpr double kShare = 0.15;
  return pose.load->at + kShare * ArmProportions(pose).length * pose.load->force.normalized();
}

void addArm(Mesh& mesh, const ArmPose& pose, const Palette& palette) {
  const ArmProportions proportions(pose);
  const double faint = pose.ghost ? 0.4 : 1;
  const Paint paint{paler(palette.link, faint, palette.paper), paler(palette.joint, faint, palette.paper),
                    paler(palette.target, faint, palette.paper)};
  const auto& points = pose.joint_points;
  addPedestal(mesh, points.front(), proportions.base_radius, paint.joint);
  double along = 0;
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const double radius = proportions.radiusAt(along);
    along += (points[i + 1] - points[i]).norm();
    const double next = proportions.radiusAt(along);
    if (i == 0) {
      addWaist(mesh, pose, radius, next, paint);
      continue;
    }
    addDrum(mesh, points[i], pose.axis_directions[i], radius, paint.joint);
    mesh.addCone(points[i], radius, points[i + 1], next, paint.link);
  }
  addFlange(mesh, pose, proportions, paint);
}

Eigen::AlignedBox3d extentOf(const ArmScene& scene, double magnification, const Eigen::Matrix3d& base_to_view) {
  Eigen::AlignedBox3d box;
  const auto include = [&](const Eigen::Vector3d& point, double around) {
    const Eigen::Vector3d p = base_to_view * point;
    box.extend(p - Eigen::Vector3d::Constant(around));
    box.extend(p + Eigen::Vector3d::Constant(around));
  };
  for (const ArmPose& pose : scene.poses) {
    const ArmProportions proportions(pose);
    for (const auto& point : pose.joint_points) include(point, 1.8 * proportions.base_radius);
    const Eigen::Vector3d& first = pose.joint_points.front();
    include({first.x(), first.y(), std::min(0.0, first.z())}, 2.2 * proportions.base_radius);
    if (drawsLoad(pose)) include(loadTip(pose), proportions.tip_radius);
  }
  const double around = ArmProportions(scene.poses.front()).tip_radius;
  for (const auto& point : pointsOf(scene, magnification)) include(point, around);
  for (const auto& point : scene.also_fitted) include(point, around);
  return box;
}

FloorGrid floorOf(const ArmScene& scene) {
  const Eigen::AlignedBox3d box = extentOf(scene, 0, Eigen::Matrix3d::Identity());
  const double step = std::max(0.5, roundUp125(box.sizes().head<2>().maxCoeff() / 12));
  const auto below = [step](double x) { return static_cast<int>(std::floor(x / step)); };
  const auto above = [step](double x) { return static_cast<int>(std::ceil(x / step)); };
  return {step, below(box.min().x()), above(box.max().x()), below(box.min().y()), above(box.max().y())};
}

}  // namespace stiffscope::render
