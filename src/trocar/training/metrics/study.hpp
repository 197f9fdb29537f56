// Many attempts of several people together: how each metric spreads, and whether it changes with repetition.
//
//   const Study study = study_of(attempts);      // attempts: who, the how-manieth, metrics
//   use(study_json(study));
//
// A correlation says something about these people and this task only. With few people its range, when each is left out
// in turn, says more than the figure; both are always given together. docs/guides/metrics.md
#pragma once

#include <span>

#include <trocar/training/metrics/metrics.hpp>

namespace trocar::training {

/// A metric of an attempt as one number.
struct MetricColumn {
  const char *key, *title, *unit;
  int better;  ///< +1: more is meant to be better, -1: less is, 0: neither
  double (*get)(const Metrics&);
};
/// All of them, for all hands together, in the order in which reports show them.
std::span<const MetricColumn> metric_columns();

struct StudyAttempt {
  std::string person, trial;
  int repetition = 1;  ///< 1 = the person's first
  Metrics metrics;
};

/// Quartiles by linear interpolation between ordered values. NaN values do not count; without any all is NaN.
struct Spread {
  int count = 0;
  double least = kNoMetric, lower = kNoMetric, median = kNoMetric, upper = kNoMetric, most = kNoMetric;
};
Spread spread_of(std::vector<double> values);

/// A figure, and the smallest and largest it takes when each person in turn is left out (NaN with fewer than three).
struct Ranged {
  double value = kNoMetric, low = kNoMetric, high = kNoMetric;
};

/// How a metric changes with repetition.
struct Trend {
  Ranged slope;   ///< per repetition: least squares, with an offset of each person's own
  Ranged pooled;  ///< Spearman's rho of repetition and metric over all attempts
  Ranged within;  ///< the mean of each person's own rho: differences between people do not enter
};

struct MetricStudy {
  const MetricColumn* column = nullptr;
  Spread all;
  std::vector<Spread> by_person;      ///< in the order of Study::persons
  std::vector<Spread> by_repetition;  ///< [0]: first attempts
  std::vector<double> person_rho;     ///< each person's own Spearman rho
  Trend trend;
};

struct Study {
  std::vector<std::string> persons;  ///< in the order of their first attempt
  std::vector<StudyAttempt> attempts;
  std::vector<MetricStudy> metrics;  ///< one for each of metric_columns()
};
Study study_of(std::vector<StudyAttempt> attempts);

/// Spearman's rho with mean ranks for ties; NaN for fewer than three pairs or no variation.
double spearman(std::span<const double> a, std::span<const double> b);

/// One JSON object: spreads, trends and each attempt's figures.
std::string study_json(const Study& study);

}  // namespace trocar::training
