// Judges bleeding control: an artery opens by itself (sim::Bleeder); find the place, clip the artery on its heart's
// side and wherever else it is fed from, clear what has run out, look whether it stays dry. Reads State only.
#pragma once

#include <array>

#include <trocar/training/exercise/energy_watch.hpp>
#include <trocar/training/exercise/finder.hpp>
#include <trocar/training/exercise/judge.hpp>

namespace trocar::training {

/// What is known of the bleeding; for results and for whoever shows them.
struct BleedingFacts {
  double began = -1, stopped = -1;                  ///< [s]; below 0: not yet. Stopped: for good, or as of now
  double flow = 0;                                  ///< out of all vessels, over the last second [m^3/s]
  double lost = 0, pool = 0;                        ///< blood that left vessels; what the pool holds [m^3]
  int upstream = 0, downstream = 0, elsewhere = 0;  ///< clips, by where they are
};

class BleedingJudge final : public Judge {
 public:
  /// @param faults  gets all that the scene lacks; with any of them the judge is of no use
  BleedingJudge(const Exercise& exercise, const sim::Model& model, Scoreboard& board, Faults& faults);

  void tick(const sim::Model& model, const sim::State& state, const sim::StepReport& report) override;
  void sample(const sim::Model& model, const sim::State& state, std::span<const Vec3d> tips, double dt) override;
  int current() const override;
  const std::string& side_of_hold(std::int32_t body) const override;
  void tell(nlohmann::ordered_json& result) const override;

  const BleedingFacts& facts() const { return m_facts; }

 private:
  void judge_clip(const sim::Model& model, const sim::State& state, int number);
  void measure(const sim::State& state);
  void watch_loss(Vec3d where);
  void watch_pool(Vec3d where);
  void tell_all(const Mishaps& mishaps);
  /// Does the pool stand over it?
  bool drowned(const sim::Model& model, const sim::State& state, Vec3d where) const;
  int step(BleedingTask task) const { return int(task); }

  const Exercise& m_exercise;
  const BleedingControl& m_goal;
  Scoreboard& m_board;
  int m_target = -1;  ///< of visibility: the bleeding place
  BleedingFacts m_facts;
  std::array<double, 50> m_lost_before{};  ///< one a sample, of the last second [m^3]
  int m_sample = 0;
  int m_band = 0;                       ///< how much blood has been told to be lost
  bool m_late = false, m_left = false;  ///< it has been told that control comes late, that the pool was left
  int m_clips_judged = 0, m_cuts_judged = 0;
  EnergyWatch m_energy;
};

}  // namespace trocar::training
