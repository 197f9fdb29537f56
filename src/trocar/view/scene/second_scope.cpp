#include <algorithm>

#include <trocar/view/base/cameras.hpp>
#include <trocar/view/scene/second_scope.hpp>

namespace trocar::view {
namespace {

constexpr double kFirstDepth = 0.06, kShallowest = 0.02, kScopeDeepest = 0.20;  // [m] of the tip in the body

kinematics::FulcrumLimits limits() {
  kinematics::FulcrumLimits l;
  l.depth_min = kShallowest;
  l.depth_max = kScopeDeepest;
  return l;
}

double room_at(const sim::Model& model, Vec3d place) {
  double least = length(place - model.scope.port);
  for (const sim::HandModel& h : model.hands) least = std::min(least, length(place - h.port));
  return least;
}

}  // namespace

SecondScope second_scope_of(const sim::Model& model) {
  SecondScope scope;
  const Vec3d first = model.scope.port;
  scope.port = first + Vec3d{0.04, 0, 0};  // beside it, where there are no hands
  double most = 0;
  for (const sim::HandModel& h : model.hands) {
    const Vec3d place = 0.5 * (first + h.port);
    const double room = room_at(model, place);
    if (room > most + 1e-9) most = room, scope.port = place;
  }
  const Vec3d middle = orbit_around(model).target;
  const Vec3d tip = scope.port + kFirstDepth * normalised(middle - scope.port, Vec3d{0, 0, -1});
  scope.pose = clamped(kinematics::inverse(scope.port, tip, 0), limits());
  return scope;
}

void aim(SecondScope& scope, double right, double up) {
  const kinematics::ScopeFrame now = scope_frame(scope.port, scope.pose, 0, 0);
  const Vec3d along = now.forward + right * now.right + up * now.up;
  const double depth = scope.pose.depth;
  scope.pose =
      clamped(kinematics::inverse(scope.port, scope.port + depth * normalised(along, now.forward), 0), limits());
}

void advance(SecondScope& scope, double by) {
  scope.pose.depth += by;
  scope.pose = clamped(scope.pose, limits());
}

ViewOptions view_through(const SecondScope& scope) {
  const kinematics::ScopeFrame frame = scope_frame(scope.port, scope.pose, 0, 0);
  ViewOptions options;
  options.camera = ViewOptions::Camera::inside;
  options.eye = frame.eye;
  options.target = frame.eye + 0.1 * frame.forward;
  options.up = frame.up;
  options.second_scope = scope;
  return options;
}

}  // namespace trocar::view
