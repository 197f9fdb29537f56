// Judges tubal sterilisation: survey, and on each side identify, present, clip, clip, cut, check. Reads State only.
#pragma once

#include <array>
#include <vector>

#include <trocar/training/exercise/finder.hpp>
#include <trocar/training/exercise/following.hpp>
#include <trocar/training/exercise/judge.hpp>
#include <trocar/training/exercise/lumen_check.hpp>

namespace trocar::training {

/// What is known of one side; for results and for whoever shows them.
struct SideFacts {
  struct ClipFact {
    double s = 0, theta = 0, cover = 0, closing = 0;  ///< [m] [rad] - [s]
    int tips_visible = 0;
    bool counts = false;  ///< rightly set in a place of a clip: a pair may be made with it
    bool good = false;    ///< made no error
    double at = 0;        ///< when [s]
  };
  struct Cut {
    double s = 0, fraction = 0, beyond = 0;  ///< [m] - [m]
    bool good = false;
    double at = 0;
  };
  std::array<ClipFact, interactions::kMaxClips> clips{};
  std::array<Cut, interactions::kMaxCuts> cuts{};
  int clip_count = 0, cut_count = 0;
  std::array<double, 2> pair{-1, -1};              ///< where the first and the second clip are [m], below 0: not yet
  double straightness = 0, best_straightness = 0;  ///< of the isthmus: now, and the best while presented
  Range pull{0, 0};                                ///< on this tube while held; both 0: never held
  bool held = false;
};

class SterilisationJudge final : public Judge {
 public:
  /// @param faults  gets all that the scene lacks (strands, organs, instruments, landmarks); with any of them the judge
  ///                is of no use
  SterilisationJudge(const Exercise& exercise, const sim::Model& model, Scoreboard& board, Faults& faults);

  void tick(const sim::Model& model, const sim::State& state, const sim::StepReport& report) override;
  void sample(const sim::Model& model, const sim::State& state, std::span<const Vec3d> tips, double dt) override;
  int current() const override;  ///< on the side that is being worked on
  const std::string& side_of_hold(std::int32_t body) const override;
  void tell(nlohmann::ordered_json& result) const override;

  const SideFacts& facts(int side) const { return m_sides[size_t(side)].facts; }
  bool occluded(int side) const { return m_sides[size_t(side)].lumen.occluded(); }
  bool occluded() const;  ///< no way through any of the tubes

 private:
  /// A side as indices, and how far it has come.
  struct SideWatch {
    int tube = -1, mesosalpinx = -1;  ///< strand; membrane, or -1
    int ovary_target = -1, trace_target = -1;
    double isthmus = 0, ampulla = 0;  ///< where each ends [m]
    Following following;
    LumenCheck lumen;
    SideFacts facts;
    bool blamed = false;  ///< not identified: once a side
    bool severed = false;
  };

  void measure_side(SideWatch& side, const sim::Model& model, const sim::State& state, std::span<const Vec3d> tips,
                    double dt);
  void watch_survey(const sim::Model& model, const sim::State& state, double dt);
  void judge_clip(const sim::Model& model, const sim::State& state, const interactions::Clip& clip);
  void place_clip(SideWatch& side, int index, double s, Vec3d where);
  void judge_cut(const sim::Model& model, const sim::State& state, const interactions::Cut& cut);
  void judge_snip(const sim::Model& model, const sim::State& state, const interactions::Cut& cut);
  void touch_side(SideWatch& side, Vec3d where);
  bool presented(const SideWatch& side, const sim::Model& model, const sim::State& state) const;
  /// Does this hand hold the side's tube beyond the isthmus, or its mesosalpinx?
  bool holds(const SideWatch& side, const sim::Model& model, const sim::State& state, size_t hand) const;
  int side_of(int tube) const;
  int side_of_fold(int membrane) const;

  int step_index(int side, Task task) const { return task == Task::survey ? 0 : side * (kTasks - 1) + int(task); }
  void done(int side, Task task);
  void missed(int side, Task task) { m_board.missed(step_index(side, task)); }
  void latch(int side, Task task, bool condition, double hold, double dt);
  void make_error(const char* code, int side, Vec3d where, std::string detail = {});
  std::string named(const std::string& body) const;  ///< what people call it

  const Exercise& m_exercise;
  const Sterilisation& m_goal;
  Scoreboard& m_board;
  std::vector<SideWatch> m_sides;
  std::vector<int> m_organs;       ///< targets of the survey
  std::vector<double> m_seen_for;  ///< (m_organs) [s]; at least the survey's time once it was reached
  int m_clips_judged = 0, m_cuts_judged = 0, m_focus = 0;
};

}  // namespace trocar::training
