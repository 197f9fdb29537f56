// The inputs that are no hands: a recording's, a motion file's, and resting ones.
#pragma once

#include <trocar/attempt/hand_pilot.hpp>
#include <trocar/attempt/lesson.hpp>
#include <trocar/devices/mailbox.hpp>
#include <trocar/devices/motion_file.hpp>
#include <trocar/sim/recording/recording.hpp>
#include <trocar/training/expert/expert.hpp>

namespace trocar::attempt {

/// Everything stays where it was placed. For pictures and benchmarks.
class RestingSource : public InputSource {
 public:
  explicit RestingSource(const sim::Model& model) : m_input(model.start) {}
  bool next(const sim::State&, sim::Input& input) override {
    input = m_input;
    return true;
  }

 private:
  sim::Input m_input;
};

/// Hands: their newest command, which comes at display rate, as smooth motion.
class HandsSource : public InputSource {
 public:
  explicit HandsSource(const sim::Model& model) : m_command(model.start), m_smooth(model.start) {}
  void put(const sim::Input& command) { m_commands.put(command); }  ///< one other thread
  bool next(const sim::State&, sim::Input& input) override {
    m_commands.take(m_command);
    input = m_smooth.step(m_command);
    return true;
  }

 private:
  devices::Mailbox<sim::Input> m_commands;
  sim::Input m_command;
  SmoothInput m_smooth;
};

/// The inputs of a recording, tick by tick.
class ReplaySource : public InputSource {
 public:
  explicit ReplaySource(std::vector<sim::Input> inputs) : m_inputs(std::move(inputs)) {}
  bool next(const sim::State& state, sim::Input& input) override;

 private:
  std::vector<sim::Input> m_inputs;
};

/// The demonstration: reads the State as an eye would and does the exercise.
class SurgeonSource : public InputSource {
 public:
  SurgeonSource(const training::Exercise& exercise, const sim::Model& model, std::uint64_t seed)
      : m_model(model), m_expert(training::make_expert(exercise, model, {}, seed)) {}
  bool next(const sim::State& state, sim::Input& input) override;
  void after(const sim::State& state, const sim::StepReport& report) override;
  Json describe() const override;

 private:
  void note_doing(std::uint64_t tick);

  const sim::Model& m_model;
  std::unique_ptr<training::Expert> m_expert;
  Json m_performed = Json::array();  ///< goal and skill from a tick on
  std::string m_goal, m_skill;       ///< as noted last
};

/// How a hand of a motion file comes into the scene: a rotation and a shift, scale 1.
struct HandPlacement {
  int tool = -1;                     ///< the instrument that the hand leads
  Vec3d centre;                      ///< where the trial's centroid of this hand goes [m]
  Mat3d axes = Mat3d::identity();    ///< columns: where the file's x, y and z point
  std::array<double, 3> centroid{};  ///< of the trial [m]

  Vec3d to_scene(const std::array<double, 3>& tip) const;
};

/// The stated transform: see docs/guides/motion_input.md.
std::array<HandPlacement, 2> place_hands(const sim::Model& model, const devices::MotionTrial& trial);

/// Both hands of a recorded trial: first both tips go to where the trial begins, then they follow it.
class MotionSource : public InputSource {
 public:
  MotionSource(const sim::Model& model, const std::string& argument);  ///< @throws core::BadInput
  bool next(const sim::State& state, sim::Input& input) override;
  void after(const sim::State& state, const sim::StepReport& report) override;
  Json describe() const override;

 private:
  struct Hand {
    HandPlacement place;
    devices::MotionBounds bounds;
    Vec3d start;  ///< of the tip, before the approach
    double start_roll = 0, first_roll = 0;
    Vec3d last_tip;
    std::size_t row = 0;                  ///< of the trial, the one passed last
    double since_row = 0;                 ///< way of the tip since that row [m]
    bool row_reachable = true;            ///< everything since that row
    double file_path = 0, performed = 0;  ///< between rows all of whose ticks were reachable [m]
    std::uint64_t touching = 0;           ///< ticks with tissue on the instrument
    std::uint64_t unreachable = 0;        ///< ticks
  };
  void aim(Hand& hand, devices::Hand which, std::uint64_t tick, sim::ToolInput& input);

  const sim::Model& m_model;
  devices::MotionTrial m_trial;
  devices::MotionCurve m_curve;
  std::array<Hand, 2> m_hands;
  std::uint64_t m_approach = 0;  ///< ticks before the trial begins
  std::uint64_t m_tick = 0;
};

/// The source that --input names: demo, motion:FILE, replay:FILE.  @throws core::BadInput
std::unique_ptr<InputSource> make_source(const Lesson& lesson, const std::string& input);

}  // namespace trocar::attempt
