// Tools that a tracker sees control some of the hands, or the camera; the other inputs control the rest. While a tool
// is not seen, time stands still; where it is seen again elsewhere, its instrument goes there at kCatchSpeed.
//
//   TrackedSource source(hands, model, plan, tracker);        // all must outlive it
#pragma once

#include <memory>

#include <trocar/attempt/hand_pilot.hpp>
#include <trocar/attempt/lesson.hpp>
#include <trocar/attempt/team/duty.hpp>
#include <trocar/attempt/tracker/tracker_file.hpp>
#include <trocar/devices/tracker/tracker_thread.hpp>

namespace trocar::attempt {

/// One tool's pose as the pose of an instrument through its trocar. The tip follows the tool's tip; the shaft goes
/// through the trocar, whatever the tool's own direction; the roll follows how the tool turns.
class TrackedTool {
 public:
  TrackedTool(const TrackerPlan& plan, const TrackerPlan::Tool& tool) : m_plan(plan), m_tool(tool) {}

  /// @param placed  where it is while the tool has not been seen yet
  kinematics::FulcrumPose follow(const devices::TrackedPose& seen, Vec3d port, const kinematics::FulcrumPose& placed);

 private:
  const TrackerPlan& m_plan;
  const TrackerPlan::Tool& m_tool;
  bool m_seen = false;
  Vec3d m_from, m_to;  ///< the tip as it was first seen: by the tracker, in the scene [m]
  Mat3d m_first;       ///< how the tool stood then, in the scene's axes
  Vec3d m_opening;     ///< where the instrument's jaws opened then
  double m_roll = 0;
};

class TrackedSource : public InputSource {
 public:
  /// @throws core::BadInput for a role that the scene has not, or two tools that lead the same;
  /// core::EnvironmentLacks where no tracker's server listens
  TrackedSource(InputSource& own, const sim::Model& model, const TrackerPlan& plan);

  bool ready() override { return m_own.ready() && missing().empty(); }
  std::string waits_for() const override;
  std::uint64_t behind() const override { return m_own.behind(); }
  bool next(const sim::State& state, sim::Input& input) override;
  void after(const sim::State& state, const sim::StepReport& report) override { m_own.after(state, report); }
  std::optional<DeviceNews> device() const override;
  Json describe() const override;

 private:
  struct Led {
    const TrackerPlan::Tool* tool;
    Duty duty;
    int hand;  ///< or devices::kScope
    TrackedTool pose;
    bool catches;          ///< the tool was elsewhere while time stood still, or nobody saw it
    std::int64_t seen_at;  ///< [ns]
  };
  std::string missing() const;
  std::string never_seen(const std::string& name, const std::string& why) const;
  void follow(Led& led, const devices::TrackedPose& seen, const sim::State& state, const sim::Input& given);

  InputSource& m_own;
  const sim::Model& m_model;
  const TrackerPlan m_plan;
  std::vector<Led> m_led;
  sim::Input m_wanted;
  std::unique_ptr<SmoothInput> m_smooth;  ///< made with the first tick
  std::int64_t m_last_next = 0;           ///< when [ns]
  devices::TrackerThread m_tracker;
};

}  // namespace trocar::attempt
