// Records a demonstration on a thread of its own, so that the window stays usable: the exercise is compiled again, the
// demonstration performs it without a picture, and the finished recording is kept (kept_demonstration.hpp). What is
// cancelled or fails leaves no file.
//
//   DemonstrationMaker maker;
//   maker.start("basics/camera-0", seed);
//   const auto p = maker.progress();                   // every picture
//   if (p.stage == DemonstrationMaker::Stage::done) play(p.file);
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace trocar::attempt {

class DemonstrationMaker {
 public:
  enum class Stage { idle, preparing, recording, done, failed, cancelled };
  struct Progress {
    Stage stage = Stage::idle;
    std::string exercise, title;
    std::uint64_t seed = 0;
    double seconds = 0;          ///< recorded so far [s]
    double expected = 0;         ///< that it is expected to take [s]; 0: not known yet
    std::string failure;         ///< of `failed`
    std::filesystem::path file;  ///< of `done`
    bool passed = true;          ///< of `done`: it reached the pass mark
    /// 0..1; a demonstration that takes longer than expected stays just below 1.
    double share() const;
  };

  DemonstrationMaker();
  ~DemonstrationMaker();  ///< cancels, and waits for it
  DemonstrationMaker(const DemonstrationMaker&) = delete;
  DemonstrationMaker& operator=(const DemonstrationMaker&) = delete;

  /// Another one that is being recorded is cancelled.
  void start(const std::string& exercise, std::uint64_t seed);
  /// Returns at once; the thread ends when it can.
  void cancel();
  /// What is over is forgotten.
  void forget();
  Progress progress() const;
  bool busy() const;

 private:
  struct Job;
  std::vector<std::unique_ptr<Job>> m_jobs;  ///< the last one is the newest
};

/// Did the recording's attempt reach the pass mark?
bool reached_pass_mark(const std::string& result_json);

}  // namespace trocar::attempt
