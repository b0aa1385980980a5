#include "render/vtk/mesh.h"

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

namespace stiffscope {

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

void Mesh::addCone(const Eigen::Vector3d& from, double from_radius, const Eigen::Vector3d& to,
                   double to_radius, Colour colour) {
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

void Mesh::addDot(const Eigen::Vector3d& centre, double radius, Colour colour) {
  addSphere(centre, radius, colour, 8);
}

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
  return actor;
}

}  // namespace stiffscope
