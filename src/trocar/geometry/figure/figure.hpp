// A person lying on the back, from few figures: what ports go through, arms must not touch and a picture shows. The
// frame is the patient's: the umbilicus is the origin, x to the patient's left, y to the head, z to the front; with the
// abdomen inflated as said. Outlines are plausible and our choice; a person of 1.70 m is the pattern, others are
// scaled.
//
//   const Figure figure({.stature = 1.65, .breadth = 0.34});
//   figure.front(0.08, 0.05);                    // z of the skin there
//   figure.distance(elbow);                      // how far a place is off the body
#pragma once

#include <vector>

#include <trocar/numerics/vec3.hpp>

namespace trocar::geometry {

struct FigureSizes {
  double stature = 1.70;   ///< [m]
  double breadth = 0.326;  ///< of the waist [m]
  double depth = 0.205;    ///< back to umbilicus, inflated by `rise` [m]
  double rise = 0.030;     ///< of the abdominal wall by gas [m]
  double legs_apart = 0;   ///< between the legs [rad]
  bool arms_out = false;   ///< on boards; else beside the body
};

/// A rod with round ends of two sizes: a part of a limb, a head.
struct Limb {
  Vec3d a, b;
  double radius_a = 0, radius_b = 0;
};
/// Least distance of a point from a limb's surface; below 0: inside.
double distance(const Limb& limb, Vec3d p) noexcept;

class Figure {
 public:
  explicit Figure(const FigureSizes& sizes = {});

  /// Across the trunk at y: an ellipse in front of `middle`, something squarer behind it.
  struct Section {
    double half = 0, front = 0, middle = 0, back = 0;  ///< half breadth; z of the skin in front, widest, behind [m]
  };
  Section section(double y) const noexcept;
  double low() const noexcept { return m_rows.front().y; }  ///< y at which the trunk ends at the legs [m]
  double high() const noexcept { return m_rows.back().y; }  ///< and at the neck
  double back() const noexcept { return m_back; }           ///< z of the lowest place: on what it lies [m]
  double crown() const noexcept;                            ///< y of the head's top [m]
  double soles() const noexcept;                            ///< y of the feet's end [m]

  /// z of the trunk's skin seen from the front; beside it that of its edge.
  double front(double x, double y) const noexcept;
  /// Unit, outwards, of that skin.
  Vec3d normal(double x, double y) const noexcept;
  /// How far a point is off the body, to first order of the trunk's shape, exact of limbs; below 0: in it.
  double distance(Vec3d p) const noexcept;
  /// The same of the trunk alone.
  double trunk_distance(Vec3d p) const noexcept;
  /// The same of a rod, looked at every 5 mm: the least distance of its middle line less its radius.
  double distance(Vec3d a, Vec3d b, double radius) const noexcept;

  const std::vector<Limb>& limbs() const noexcept { return m_limbs; }  ///< head, neck, arms, legs
  const FigureSizes& sizes() const noexcept { return m_sizes; }

 private:
  struct Row {
    double y = 0;
    Section s;
  };
  FigureSizes m_sizes;
  std::vector<Row> m_rows;
  std::vector<Limb> m_limbs;
  double m_back = 0;
};

}  // namespace trocar::geometry
