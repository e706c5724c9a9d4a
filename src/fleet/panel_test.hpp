#pragma once
// Robust score tests of one panel for changes. The same arithmetic is done on the fleet's values and on drawn ones, so that the
// threshold includes whatever the tests do: robust fits, and the scale found from the values themselves.

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "coast/fleet/changes.hpp"

namespace coast::fleet {

/// A change that was tested.
struct Candidate {
  ChangeKind kind = ChangeKind::kStep;
  bool shared = false;
  std::size_t unit = 0;  ///< where it is not shared
  double t = 0.0;        ///< of a step
  std::size_t factor = 0;
  std::string level;
  double statistic = 0.0;
};

/// The candidates with the largest statistics; 0 where nothing can be tested.
struct Strongest {
  Candidate own;     ///< of one unit
  Candidate shared;  ///< of the sum over all units
  [[nodiscard]] double statistic() const { return std::max(own.statistic, shared.statistic); }
};

/// One unit, whitened: z = L^-1 y, and an orthonormal basis of L^-1 X.
struct WhitenedUnit {
  Eigen::VectorXd z;
  Eigen::MatrixXd basis;
  double log_det = 0.0;  ///< log|V|
};
[[nodiscard]] WhitenedUnit whiten(const Observations& observations, const Scatter& scatter);

/// Residuals of robust fits, and the common scale that makes them have variance 1 (Huber's proposal 2, clipped at 1.5).
struct RobustFit {
  std::vector<Eigen::VectorXd> residuals;  ///< in units of the scale
  double scale = 1.0;
};
[[nodiscard]] RobustFit fit_robustly(const std::vector<WhitenedUnit>& units, const std::vector<Eigen::VectorXd>& z);

/// Robust -2 log-likelihood: squares up to 3 sigma, linear beyond.
[[nodiscard]] double loss(const Eigen::VectorXd& residuals);

class PanelTest {
 public:
  PanelTest(const Panel& panel, const std::vector<Change>& changes, const Scatter& scatter,
            const std::vector<std::vector<bool>>& left_out);

  [[nodiscard]] const std::vector<WhitenedUnit>& units() const { return units_; }
  /// The values of the fleet, whitened.
  [[nodiscard]] std::vector<Eigen::VectorXd> values() const;
  [[nodiscard]] Strongest strongest(const std::vector<Eigen::VectorXd>& z) const;
  /// The statistic of each unit by itself for what a candidate says.
  [[nodiscard]] std::vector<double> of_units(const Candidate& candidate) const;

 private:
  struct Tested {
    std::vector<double> dates;   ///< of missions
    Eigen::MatrixXd columns;     ///< drift, splits 1 .. n - 1, levels; whitened and orthogonal to the basis
    Eigen::VectorXd energy;      ///< squared lengths; 0 where a column adds nothing to the basis
    std::vector<bool> for_unit;  ///< whether the unit by itself is tested for this column
  };
  struct Level {
    std::size_t factor;
    std::string name;
  };
  struct Sum {
    double score = 0.0;
    double energy = 0.0;
    int units = 0;
  };
  void add_unit(const Series& series, const Design& design, const Scatter& scatter, const std::vector<Change>& changes,
                std::size_t index);
  void collect_levels(const Panel& panel);
  void consider(Candidate& best, const Sum& sum, const Candidate& candidate) const;
  void shared_steps(const std::vector<Eigen::VectorXd>& scores, Candidate& best) const;
  [[nodiscard]] Eigen::Index column_of(const Candidate& candidate, std::size_t unit) const;
  [[nodiscard]] std::vector<Eigen::VectorXd> scores(const std::vector<Eigen::VectorXd>& z) const;

  std::vector<WhitenedUnit> units_;
  std::vector<Tested> tested_;
  std::vector<Level> levels_;
  std::vector<std::pair<double, std::size_t>> timeline_;  ///< every mission: date, unit; by date
};

}  // namespace coast::fleet
