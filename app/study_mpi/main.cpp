// trocar_study_mpi: `trocar mechanism FILE tolerance` on many machines. Each rank takes a run of samples; all values go
// to rank 0, which takes the statistics in their order, so that the numbers are those of one rank, bit by bit.
//
//   mpirun -np 4 build/release/trocar_study_mpi grasper --frame tip_upper --plus-minus-um 10
#include <exception>
#include <limits>

#include <fmt/format.h>
#include <mpi.h>

#include <trocar/core/error.hpp>
#include <trocar/scene/mechanisms/mechanism_file.hpp>

#include "commands/mechanisms/study_options.hpp"
#include "commands/number_options.hpp"

namespace {

using namespace trocar;

/// MPI begun and ended.
struct MpiSession {
  MpiSession(int& argc, char**& argv) {
    MPI_Init(&argc, &argv);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  }
  ~MpiSession() { MPI_Finalize(); }
  MpiSession(const MpiSession&) = delete;
  MpiSession& operator=(const MpiSession&) = delete;
  int rank = 0, ranks = 1;
};

std::int64_t share_start(std::int64_t samples, int rank, int ranks) { return samples * rank / ranks; }

void study(const app::StudyOptions& o, const MpiSession& mpi) {
  const app::StudyTask task = app::prepare(kinematics::build(scene::read_mechanism(app::mechanism_file(o.file))), o);
  const std::int64_t first = share_start(o.samples, mpi.rank, mpi.ranks);
  std::vector<double> own(std::size_t(share_start(o.samples, mpi.rank + 1, mpi.ranks) - first));
  const double began = MPI_Wtime();
  core::ThreadPool pool(o.threads > 0 ? o.threads : 1);
  task.study->sample(std::uint64_t(o.seed), first, own, &pool);
  std::vector<int> counts, starts;
  for (int r = 0; r < mpi.ranks; ++r) {
    starts.push_back(int(share_start(o.samples, r, mpi.ranks)));
    counts.push_back(int(share_start(o.samples, r + 1, mpi.ranks)) - starts.back());
  }
  std::vector<double> all(mpi.rank == 0 ? std::size_t(o.samples) : 0);
  MPI_Gatherv(own.data(), int(own.size()), MPI_DOUBLE, all.data(), counts.data(), starts.data(), MPI_DOUBLE, 0,
              MPI_COMM_WORLD);
  if (mpi.rank != 0) return;
  const double seconds = MPI_Wtime() - began;
  Json out = app::study_json(task, all, studies::statistics(all, task.study->linear().nominal, task.limits, o.bins));
  out["ranks"] = mpi.ranks;
  out["seconds"] = seconds;
  fmt::print("{}\n", out.dump());
}

int run(int argc, char** argv, const MpiSession& mpi) {
  app::StudyOptions o;
  CLI::App words("A tolerance study of a mechanism on many machines; prints JSON", "trocar_study_mpi");
  words.add_option("file", o.file, "a mechanism's file (.json, .urdf), or its name under scenes/mechanisms")
      ->required();
  words.add_option("--frame", o.frame, "which frame is measured; default: tip, else the first");
  words.add_option("--drive", o.drives, "an actuator, as NAME=0..1");
  words.add_option("--samples", o.samples, "how many")
      ->transform(app::whole_number(1, 10'000'000))
      ->capture_default_str();
  app::add_study_options(words, o);
  try {
    words.parse(argc, argv);
    study(o, mpi);
    return core::kDone;
  } catch (const CLI::ParseError& e) {
    const int code = mpi.rank == 0 ? words.exit(e) : e.get_exit_code();
    return code == 0 ? core::kDone : core::kBadInput;
  } catch (const core::BadInput& e) {
    if (mpi.rank == 0)
      for (const core::Fault& fault : e.faults()) fmt::print(stderr, "{}\n", core::to_string(fault));
    return core::kBadInput;
  } catch (const std::invalid_argument& e) {  // the pose is none that a study can be about: the same on every rank
    if (mpi.rank == 0) fmt::print(stderr, "{}\n", e.what());
    return core::kGoalNotReached;
  }
}

}  // namespace

int main(int argc, char** argv) {
  const MpiSession mpi(argc, argv);
  return run(argc, argv, mpi);
}
