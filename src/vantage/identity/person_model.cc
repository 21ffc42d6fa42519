// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/identity/person_model.h"

#include <Eigen/Eigenvalues>

namespace vantage {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

// Fewer observations of a person say too little of how they vary.
constexpr Index kFewestOfPerson = 3;
// A covariance of few observations has axes of hardly any noise by chance: so much of what it says
// of pairs of dimensions is not believed.
constexpr double kShrinkage = 0.2;
// Axes along which people vary less than this, in units of the noise, say nothing.
constexpr double kLeastBetween = 0.05;
// Values that lie further out, in standard deviations, are pulled in to there.
constexpr double kOutlier = 3;

}  // namespace

std::optional<PersonModel> PersonModel::Learn(std::span<const MatrixXd> people) {
  Index persons = 0;
  Index rows = 0;
  Index size = 0;
  double inverse_counts = 0;
  for (const MatrixXd& observations : people) {
    if (observations.rows() < kFewestOfPerson) continue;
    ++persons;
    rows += observations.rows();
    size = observations.cols();
    inverse_counts += 1.0 / static_cast<double>(observations.rows());
  }
  const Index freedom = rows - persons;
  if (persons < 2 || freedom <= size) return std::nullopt;

  MatrixXd means(persons, size);
  MatrixXd rests(rows, size);
  Index person = 0;
  Index row = 0;
  for (const MatrixXd& observations : people) {
    if (observations.rows() < kFewestOfPerson) continue;
    means.row(person) = observations.colwise().mean();
    rests.middleRows(row, observations.rows()) = observations.rowwise() - means.row(person);
    row += observations.rows();
    ++person;
  }
  // Who was somebody else for a while would make the noise of everybody larger.
  const RowVectorXd limits =
      kOutlier * (rests.array().square().colwise().sum() / static_cast<double>(freedom)).sqrt();
  for (Index i = 0; i < rows; ++i) {
    rests.row(i) = rests.row(i).cwiseMin(limits).cwiseMax(-limits).eval();
  }
  MatrixXd within = rests.transpose() * rests / static_cast<double>(freedom);
  const VectorXd variances = within.diagonal();
  within *= 1 - kShrinkage;
  within.diagonal() += kShrinkage * variances;
  // What does not vary at all has no scale: a thousandth of the usual is as good as nothing.
  within.diagonal().array() += 1e-6 * variances.mean() + 1e-12;

  PersonModel model;
  model.mean_ = means.colwise().mean();
  means.rowwise() -= model.mean_.transpose();
  const MatrixXd between = means.transpose() * means / static_cast<double>(persons - 1) -
                           within * (inverse_counts / static_cast<double>(persons));
  const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> solver(between, within);
  if (solver.info() != Eigen::Success) return std::nullopt;
  const Index kept = (solver.eigenvalues().array() > kLeastBetween).count();  // the last ones
  if (kept == 0) return std::nullopt;
  model.between_ = solver.eigenvalues().tail(kept).array();
  model.axes_ = solver.eigenvectors().rightCols(kept).transpose();
  return model;
}

VectorXd PersonModel::Project(const VectorXd& observation) const {
  const VectorXd limits = (kOutlier * (1 + between_).sqrt()).matrix();
  return (axes_ * (observation - mean_)).cwiseMin(limits).cwiseMax(-limits);
}

double PersonModel::Evidence(const VectorXd& sum, double count) const {
  const ArrayXd scaled = 1 + count * between_;
  return 0.5 * (sum.array().square() * between_ / scaled - scaled.log()).sum();
}

}  // namespace vantage
