#include "vacuum_gripper_sim/core/linearized_contacts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace vacuum_gripper_sim {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Groups of 9, 6 and 3 rows, of contacts with a normal and two tangents, and two bodies' ways.
class LinearizedContactsTest : public testing::Test {
 protected:
  LinearizedContactsTest() {
    for (const Index size : {9, 6, 3}) {
      const MatrixXd B = Random(size, size);
      W_.groups.push_back({W_.num_rows(), 1e-4 * B * B.transpose()});
      W_.groups.back().C.diagonal().array() += 1e-5;
    }
    W_.U = 0.02 * Random(18, 12);
    delta_ = 1e-3 * Random(18, 1);
  }
  MatrixXd Random(Index rows, Index columns) {
    return MatrixXd::NullaryExpr(rows, columns, [&] { return normal_(generator_); });
  }
  MatrixXd Dense() const {
    MatrixXd W = W_.U * W_.U.transpose();
    for (const ContactCompliance::Group& group : W_.groups) {
      W.block(group.first, group.first, group.size(), group.size()) += group.C;
    }
    return W;
  }
  static SlidingContact Sliding(Index normal, double angle) {
    const Eigen::Vector2d d(std::cos(angle), std::sin(angle));
    return {normal, normal + 1, 0.4,
            2e-4,   d,          0.7 * (Eigen::Matrix2d::Identity() - d * d.transpose())};
  }

  std::mt19937 generator_{4};
  std::normal_distribution<double> normal_;
  ContactCompliance W_;
  VectorXd delta_;
};

TEST_F(LinearizedContactsTest, ProductsAndDiagonalAreThoseOfTheDenseW) {
  EXPECT_TRUE(W_.coupled());
  const VectorXd lambda = Random(18, 1);
  VectorXd gaps = delta_;
  W_.AddTimes(-2.0, lambda, &gaps);
  EXPECT_LT((gaps - delta_ + 2.0 * Dense() * lambda).norm(),
            1e-14 * Dense().norm() * lambda.norm());
  for (Index i = 0; i < 18; ++i) {
    EXPECT_NEAR(W_.Diagonal(i), Dense()(i, i), 1e-15);
    EXPECT_EQ(&W_.GroupOf(i), &W_.groups[i < 9 ? 0 : i < 15 ? 1 : 2]);
  }
}

// Contacts: 0 sticks, 1 slides, 2 is open; 3 slides, 4 is held along its normal alone; 5 sticks.
TEST_F(LinearizedContactsTest, ForcesSatisfyTheirEquations) {
  LinearizedContacts contacts;
  VectorXd lambda;
  for (const Index ways : {12, 0}) {
    W_.U.conservativeResize(18, ways);
    const std::vector<Index> held{15, 16, 17, 0, 1, 2, 3, 9, 12};
    const std::vector<SlidingContact> sliding{Sliding(3, 0.3), Sliding(9, 2.0)};
    ASSERT_TRUE(contacts.Compute(W_, held, sliding));
    contacts.Forces(delta_, &lambda);
    const VectorXd end = delta_ + Dense() * lambda;
    for (const Index i : held) EXPECT_NEAR(end(i), 0.0, 1e-14);
    for (const SlidingContact& contact : sliding) {
      const Eigen::Vector2d force = lambda.segment<2>(contact.tangent);
      const Eigen::Vector2d left =
          contact.scale * (force - contact.friction * lambda(contact.normal) * contact.d);
      const Eigen::Vector2d right =
          contact.theta_P * (contact.scale * force - end.segment<2>(contact.tangent));
      EXPECT_LT((left - right).norm(), 1e-14);
    }
    for (const Index i : {6, 7, 8, 13, 14}) EXPECT_EQ(lambda(i), 0.0);
  }
}

// A node between two bodies has two contacts in one direction, which those alone tell apart.
TEST_F(LinearizedContactsTest, BodiesTellApartWhatIsOneToTheCup) {
  MatrixXd& C = W_.groups[0].C;
  C.row(3) = C.row(0);
  C.col(3) = C.col(0);
  const std::vector<Index> held{0, 1, 2, 3, 9, 15};
  LinearizedContacts contacts;
  ASSERT_TRUE(contacts.Compute(W_, held, {}));
  VectorXd lambda;
  contacts.Forces(delta_, &lambda);
  const VectorXd end = delta_ + Dense() * lambda;
  for (const Index i : held) EXPECT_NEAR(end(i), 0.0, 1e-10);
}

TEST_F(LinearizedContactsTest, TellsWhatHasNoSolution) {
  W_.groups[1].C(0, 0) = -1.0;
  LinearizedContacts contacts;
  EXPECT_FALSE(contacts.Compute(W_, {0, 9}, {}));
  EXPECT_TRUE(contacts.Compute(W_, {0, 10}, {}));
}

TEST_F(LinearizedContactsTest, NothingHeldIsNoForce) {
  LinearizedContacts contacts;
  ASSERT_TRUE(contacts.Compute(W_, {}, {}));
  VectorXd lambda;
  contacts.Forces(delta_, &lambda);
  EXPECT_EQ(lambda, VectorXd::Zero(18));
}

}  // namespace
}  // namespace vacuum_gripper_sim
