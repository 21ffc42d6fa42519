// SPDX-FileCopyrightText: The Vantage authors
// SPDX-License-Identifier: MIT
#include "vantage/identity/person_model.h"

#include <gmock/gmock.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "vantage/identity/test_people.h"

namespace vantage {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::DrawPeople;
using testing::Draws;

/// Variance of people along an axis, from the evidence of single observations at 0 and at 1, which
/// differ by between / (1 + between) / 2.
double Between(const PersonModel& model, Index axis) {
  const VectorXd none = VectorXd::Zero(model.axes());
  const double share =
      2 * (model.Evidence(VectorXd::Unit(model.axes(), axis), 1) - model.Evidence(none, 1));
  return share / (1 - share);
}

/// In descending order.
std::vector<double> Betweens(const PersonModel& model) {
  std::vector<double> all;
  for (Index axis = 0; axis < model.axes(); ++axis) all.push_back(Between(model, axis));
  std::ranges::sort(all, std::greater<>());
  return all;
}

double LogNormalDensity(const VectorXd& x, const MatrixXd& covariance) {
  const Eigen::LLT<MatrixXd> factor(covariance);
  const double log_determinant = 2 * MatrixXd(factor.matrixL()).diagonal().array().log().sum();
  return -0.5 * (x.dot(factor.solve(x)) + log_determinant +
                 static_cast<double>(x.size()) * std::log(2 * std::numbers::pi));
}

PersonModel ThreeAxes(unsigned seed) {
  Draws draws(seed);
  auto model = PersonModel::Learn(
      DrawPeople(draws, 12, 10, Eigen::Vector3d(0.7, 2, 5), Eigen::Vector3d(1, 2, 0.5)));
  return std::move(model).value();
}

TEST(PersonModel, EvidenceIsTheRatioOfNormalDensities) {
  int axes = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    const PersonModel model = ThreeAxes(seed % 5);
    axes += static_cast<int>(model.axes());
    Draws draws(seed);
    const int rows = draws.Int(1, 9);
    // An observation that counts for less than one is one of more noise.
    const double share = draws.Chance(0.5) ? 1 : 0.05 + 0.95 * draws.Unit();
    const MatrixXd noise = MatrixXd::Identity(rows, rows) / share;
    MatrixXd observations(rows, model.axes());
    double expected = 0;
    for (Index axis = 0; axis < model.axes(); ++axis) {
      const VectorXd x = 3 * draws.Normals(rows);
      observations.col(axis) = x;
      const MatrixXd person = MatrixXd::Constant(rows, rows, Between(model, axis));
      expected += LogNormalDensity(x, noise + person) - LogNormalDensity(x, noise);
    }
    const VectorXd sum = share * observations.colwise().sum().transpose();
    EXPECT_NEAR(model.Evidence(sum, share * rows), expected, 1e-8 * (1 + std::abs(expected)));
  }
  EXPECT_GT(axes, 500);
}

TEST(PersonModel, NothingSeenIsNoEvidence) {
  const PersonModel model = ThreeAxes(1);
  EXPECT_EQ(model.Evidence(VectorXd::Zero(model.axes()), 0), 0);
}

TEST(PersonModel, LearnsHowMuchPeopleDifferInUnitsOfTheNoise) {
  Draws draws(1);
  // Variances of people 25, 4, 1/4 and 0 times that of the noise.
  const Eigen::Vector4d within(2, 0.1, 7, 1);
  const Eigen::Vector4d between = within.cwiseProduct(Eigen::Vector4d(5, 2, 0.5, 0));
  const auto model = PersonModel::Learn(DrawPeople(draws, 1000, 8, between, within));
  ASSERT_TRUE(model);
  ASSERT_EQ(model->axes(), 3) << "what varies no more between people than within says nothing";
  const std::vector<double> learnt = Betweens(*model);
  EXPECT_NEAR(learnt[0], 25, 2.5);
  EXPECT_NEAR(learnt[1], 4, 0.4);
  EXPECT_NEAR(learnt[2], 0.25, 0.06);
}

/// Covariance of the projections less the mean of each person.
MatrixXd NoiseAlongAxes(const PersonModel& model, const std::vector<MatrixXd>& people) {
  MatrixXd noise = MatrixXd::Zero(model.axes(), model.axes());
  Index freedom = 0;
  for (const MatrixXd& observations : people) {
    MatrixXd projections(observations.rows(), model.axes());
    for (Index row = 0; row < observations.rows(); ++row) {
      projections.row(row) = model.Project(observations.row(row));
    }
    const Eigen::RowVectorXd mean = projections.colwise().mean();
    projections.rowwise() -= mean;
    noise += projections.transpose() * projections;
    freedom += observations.rows() - 1;
  }
  return noise / static_cast<double>(freedom);
}

TEST(PersonModel, NoiseIsOneAlongEachAxis) {
  Draws draws(2);
  const Eigen::Vector3d within(2, 0.1, 30);
  const Eigen::Vector3d between(6, 0.2, 30);
  const auto model = PersonModel::Learn(DrawPeople(draws, 300, 10, between, within));
  ASSERT_TRUE(model);
  ASSERT_EQ(model->axes(), 3);
  const auto others = DrawPeople(draws, 300, 10, between, within);
  const MatrixXd noise = NoiseAlongAxes(*model, others);
  EXPECT_LT((noise - MatrixXd::Identity(3, 3)).cwiseAbs().maxCoeff(), 0.08) << noise;
}

TEST(PersonModel, AFewObservationsOfSomebodyElseLeaveItSane) {
  Draws draws(3);
  const Eigen::Vector3d within(1, 2, 0.5);
  const Eigen::Vector3d between(5, 6, 0);
  auto people = DrawPeople(draws, 200, 25, between, within);
  const auto pure = PersonModel::Learn(people);
  for (std::size_t i = 0; i + 1 < people.size(); i += 2) {
    people[i].row(3).swap(people[i + 1].row(7));  // 4 %
  }
  const auto mixed = PersonModel::Learn(people);
  ASSERT_TRUE(pure && mixed);
  ASSERT_EQ(pure->axes(), 2);
  ASSERT_EQ(mixed->axes(), 2);
  const auto expected = Betweens(*pure);
  const auto learnt = Betweens(*mixed);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LT(learnt[i], 1.02 * expected[i]) << "more cautious";
    EXPECT_GT(learnt[i], 0.5 * expected[i]);
  }
}

TEST(PersonModel, LearnsNothingFromTooLittle) {
  Draws draws(4);
  const VectorXd between = VectorXd::Constant(6, 5);
  const VectorXd within = VectorXd::Ones(6);
  const auto learns = [&](int people, int rows) {
    return PersonModel::Learn(DrawPeople(draws, people, rows, between, within)).has_value();
  };
  EXPECT_FALSE(PersonModel::Learn({}));
  EXPECT_FALSE(learns(1, 100)) << "one person";
  EXPECT_FALSE(learns(50, 2)) << "too few of each";
  EXPECT_FALSE(learns(3, 3)) << "6 degrees of freedom, 6 dimensions";
  EXPECT_TRUE(learns(2, 5)) << "8 degrees of freedom, 6 dimensions";

  auto people = DrawPeople(draws, 1, 100, between, within);
  people.push_back(people[0].topRows(2));
  EXPECT_FALSE(PersonModel::Learn(people)) << "of the second too few";
}

TEST(PersonModel, WhoHasTooFewObservationsDoesNotCount) {
  Draws draws(5);
  const Eigen::Vector2d between(3, 2), within(1, 1);
  auto people = DrawPeople(draws, 20, 10, between, within);
  const auto model = PersonModel::Learn(people);
  people.insert(people.begin() + 3, MatrixXd::Constant(2, 2, 1e6));
  const auto same = PersonModel::Learn(people);
  ASSERT_TRUE(model && same);
  EXPECT_EQ(Betweens(*model), Betweens(*same));
  EXPECT_EQ(model->Project(Eigen::Vector2d(11, 9)), same->Project(Eigen::Vector2d(11, 9)));
}

TEST(PersonModel, PeopleWhoDoNotDifferMostlyTeachNothing) {
  int nothing = 0;
  double most = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    Draws draws(seed);
    const auto model =
        PersonModel::Learn(DrawPeople(draws, 30, 60, VectorXd::Zero(3), Eigen::Vector3d(1, 2, 3)));
    nothing += !model;
    if (model) most = std::max(most, Betweens(*model).front());
  }
  EXPECT_GT(nothing, 90);
  EXPECT_LT(most, 0.1);
}

TEST(PersonModel, ValuesThatNoPersonHasArePulledIn) {
  const PersonModel model = ThreeAxes(2);
  const VectorXd mean = VectorXd::Constant(3, 10);
  const VectorXd direction = Eigen::Vector3d(0.3, -1, 2);
  const VectorXd far = model.Project(mean + 1e5 * direction);
  EXPECT_EQ(far, model.Project(mean + 1e9 * direction));
  EXPECT_EQ(far, -model.Project(mean - 1e9 * direction));
  for (Index axis = 0; axis < model.axes(); ++axis) {
    EXPECT_NEAR(std::abs(far[axis]), 3 * std::sqrt(1 + Between(model, axis)), 1e-6);
  }
  // What is not far is not touched: linear there.
  const VectorXd near = model.Project(mean + 0.01 * direction) - model.Project(mean);
  const VectorXd twice = model.Project(mean + 0.02 * direction) - model.Project(mean);
  EXPECT_GT(near.norm(), 0);
  EXPECT_LT((twice - 2 * near).norm(), 1e-9);
}

TEST(PersonModel, OneWildObservationDoesNotRuleTheNoise) {
  Draws draws(6);
  auto people = DrawPeople(draws, 50, 20, Eigen::Vector2d(3, 3), Eigen::Vector2d(1, 1));
  people[0](5, 0) += 40;
  const auto model = PersonModel::Learn(people);
  ASSERT_TRUE(model);
  EXPECT_GT(Betweens(*model).back(), 5) << "9 without";
}

TEST(PersonModel, DimensionsThatNeverVaryChangeNothing) {
  Draws draws(7);
  const Eigen::Vector2d between(4, 2), within(1, 2);
  const auto people = DrawPeople(draws, 40, 12, between, within);
  std::vector<MatrixXd> padded;
  for (const MatrixXd& observations : people) {
    MatrixXd& wide = padded.emplace_back(MatrixXd::Constant(observations.rows(), 5, 0));
    wide.col(1) = observations.col(0);
    wide.col(2).setConstant(128);
    wide.col(4) = observations.col(1);
  }
  const auto model = PersonModel::Learn(people);
  const auto wide = PersonModel::Learn(padded);
  ASSERT_TRUE(model && wide);
  ASSERT_EQ(wide->axes(), model->axes());
  for (Index axis = 0; axis < model->axes(); ++axis) {
    EXPECT_NEAR(Between(*wide, axis), Between(*model, axis), 1e-3);
  }
  VectorXd observation(5);
  observation << 0, 12, 128, 0, 7;
  const VectorXd projection = wide->Project(observation);
  const VectorXd expected = model->Project(Eigen::Vector2d(12, 7));
  EXPECT_LT((projection.cwiseAbs() - expected.cwiseAbs()).norm(), 1e-3) << projection;

  // Nothing varies at all, or only between people.
  EXPECT_FALSE(PersonModel::Learn(DrawPeople(draws, 5, 12, VectorXd::Zero(2), VectorXd::Zero(2))));
  const auto exact = PersonModel::Learn(DrawPeople(draws, 5, 12, between, VectorXd::Zero(2)));
  ASSERT_TRUE(exact);
  EXPECT_TRUE(exact->Project(Eigen::Vector2d(12, 7)).allFinite());
  EXPECT_TRUE(std::isfinite(exact->Evidence(exact->Project(Eigen::Vector2d(12, 7)), 0.3)));
}

}  // namespace
}  // namespace vantage
