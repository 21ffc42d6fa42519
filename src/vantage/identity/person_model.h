// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

namespace vantage {

/// How observations of people vary: x = mean + person + noise, where `person` (one draw for each
/// person) and `noise` (one for each independent observation) are normal with covariances learnt
/// from the recording itself. What tells people apart is what varies between them and not within
/// them. Known as probabilistic linear discriminant analysis (Ioffe, ECCV 2006; Prince and Elder,
/// ICCV 2007).
class PersonModel {
 public:
  /// Learns both covariances. Each matrix has the independent observations of one person, a row
  /// each. That a few observations are of somebody else makes the model cautious, not wrong.
  /// None when there are not two people or not more observations than dimensions, or when nothing
  /// varies more between people than within them.
  static std::optional<PersonModel> Learn(std::span<const Eigen::MatrixXd> people);

  /// Axes that are left: those along which people differ.
  Eigen::Index axes() const { return between_.size(); }

  /// An observation along these axes, in units of the noise; values that no person has are pulled
  /// in.
  Eigen::VectorXd Project(const Eigen::VectorXd& observation) const;

  /// Logarithm of the likelihood that observations are of one and the same person, whoever it is,
  /// up to what does not depend on how observations are put together: `sum` of their projections,
  /// and their number, which need not be whole (part of an independent observation).
  double Evidence(const Eigen::VectorXd& sum, double count) const;

 private:
  Eigen::VectorXd mean_;
  Eigen::MatrixXd axes_;    // from observations less mean_: a row each
  Eigen::ArrayXd between_;  // variance of people along each axis; of the noise it is 1
};

}  // namespace vantage
