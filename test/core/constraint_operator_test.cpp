#include "vacuum_gripper_sim/core/constraint_operator.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <vector>

#include "support/block_mesh.h"
#include "support/node_matrices.h"
#include "vacuum_gripper_sim/core/cup_array.h"

namespace vacuum_gripper_sim {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kTimeStep = 0.01;  // s
/// Objects of the world below.
constexpr int kGround = 0;
constexpr int kBox = 1;
constexpr int kBall = 2;

/// Two elastic blocks in one mesh, a fixed plane and two free bodies.
class ConstraintOperatorTest : public testing::Test {
 protected:
  ConstraintOperatorTest() {
    system_.Linearize(mesh_.nodes, Eigen::Matrix3Xd::Zero(3, mesh_.nodes.cols()), kTimeStep,
                      {0.0, 2e-3}, Vector3d::Zero());
    factorization_.Analyze(system_.A_ff());
    EXPECT_TRUE(factorization_.Factorize(system_.A_ff()));
    RigidObject box = FixedObject(RigidSurface{"box", Box{{0.02, 0.04, 0.06}}});
    box.X_WO.linear() = Eigen::AngleAxisd(0.4, Vector3d::UnitZ()).toRotationMatrix();
    box.inertia = RigidInertia();
    box.inertia->mass = 0.2;
    box.inertia->p_OC = {0.001, 0.002, 0.0};
    box.inertia->about_C_O = Vector3d(3e-5, 2e-5, 1.5e-5).asDiagonal();
    RigidObject ball = FixedObject(RigidSurface{"ball", Sphere{0.02}});
    ball.X_WO.translation() = Vector3d(0.0, 0.0, 0.05);
    ball.inertia = RigidInertia();
    ball.inertia->mass = 0.1;
    ball.inertia->about_C_O = 1e-5 * Eigen::Matrix3d::Identity();
    world_.SetObjects({FixedObject(RigidSurface{"ground", Plane{}}), box, ball});
    operator_.Reset(factorization_, world_, kTimeStep);
  }

  /// @param nodes Places among the free nodes.
  Contact On(const std::vector<int>& nodes, int object, const Vector3d& normal,
             double friction) const {
    Contact contact;
    contact.num_nodes = static_cast<int>(nodes.size());
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      contact.nodes[k] = system_.free_nodes()[static_cast<std::size_t>(nodes[k])];
      contact.weights[k] = (k == 3 ? -1.0 : 1.0) / static_cast<double>(k + 1);
    }
    contact.object = object;
    contact.p_W = Vector3d(0.011, 0.004, 0.007);
    contact.normal = normal.normalized();
    contact.across = Vector3d::UnitX();
    contact.friction = friction;
    return contact;
  }
  static Contact Between(int object, int other, double friction) {
    Contact contact;
    contact.object = object;
    contact.other = other;
    contact.p_W = Vector3d(-0.004, 0.008, 0.03);
    contact.normal = Vector3d(0.2, 0.1, 1.0).normalized();
    contact.across = Vector3d::UnitX();
    contact.friction = friction;
    return contact;
  }
  std::vector<Contact> EveryKind() const {
    return {On({5}, kGround, {0.0, 0.3, 1.0}, 0.0),
            On({7}, kGround, {0.0, 0.2, 1.0}, 0.5),
            On({5}, kBox, {0.0, 1.0, 1.0}, 0.0),
            On({5, 7, 9}, kGround, {0.1, 0.0, 1.0}, 0.3),
            On({2, 7, 9, 11}, -1, {0.1, 0.5, 1.0}, 0.0),
            On({3, 4, 5}, kBall, {0.0, 1.0, 0.2}, 0.7),
            Between(kBox, kBall, 0.4),
            Between(kGround, kBox, 0.0)};
  }

  /// How the velocities of cup and bodies (side by side) change gaps and slips, contact by contact.
  MatrixXd Jacobian(const std::vector<Contact>& contacts) const {
    const Eigen::Index size = 3 * system_.num_free();
    std::vector<Eigen::RowVectorXd> rows;
    for (const Contact& contact : contacts) {
      Vector3d axes[3] = {contact.normal, Vector3d::Zero(), Vector3d::Zero()};
      axes[2] = contact.normal.cross(contact.across).normalized();
      axes[1] = axes[2].cross(contact.normal);
      for (int axis = 0; axis < (contact.friction > 0.0 ? 3 : 1); ++axis) {
        Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(size + 12);
        for (std::size_t k = 0; k < static_cast<std::size_t>(contact.num_nodes); ++k) {
          row.segment<3>(system_.FreeRow(contact.nodes[k])) += contact.weights[k] * axes[axis];
        }
        for (const auto& [object, sign] : {std::pair(contact.object, -1.0), {contact.other, 1.0}}) {
          if (object != kBox && object != kBall) continue;
          const int body = world_.BodyOf(object);
          const Vector3d arm = contact.p_W - world_.CentreOfMass(body);
          row.segment<3>(size + 6 * body) += sign * axes[axis];
          row.segment<3>(size + 6 * body + 3) += sign * arm.cross(axes[axis]);
        }
        rows.push_back(row);
      }
    }
    MatrixXd all(static_cast<Eigen::Index>(rows.size()), size + 12);
    for (Eigen::Index i = 0; i < all.rows(); ++i) all.row(i) = rows[static_cast<std::size_t>(i)];
    return all;
  }
  /// A and M on one diagonal.
  MatrixXd Mass() {
    const Eigen::Index size = 3 * system_.num_free();
    MatrixXd mass = MatrixXd::Zero(size + 12, size + 12);
    mass.topLeftCorner(size, size) = Dense(system_.A_ff());
    for (int body = 0; body < 2; ++body) {
      mass.block<6, 6>(size + 6 * body, size + 6 * body) = world_.Mass(body);
    }
    return mass;
  }
  MatrixXd DenseW(const std::vector<Contact>& contacts) {
    const MatrixXd J = Jacobian(contacts);
    return kTimeStep * kTimeStep * J * Mass().partialPivLu().solve(J.transpose());
  }
  static void ExpectNear(const MatrixXd& a, const MatrixXd& b, double relative) {
    ASSERT_EQ(a.rows(), b.rows());
    ASSERT_EQ(a.cols(), b.cols());
    EXPECT_LT((a - b).cwiseAbs().maxCoeff(), relative * b.cwiseAbs().maxCoeff());
  }

  /// W, a column at a time.
  MatrixXd W() const {
    MatrixXd W(operator_.num_rows(), operator_.num_rows());
    for (Eigen::Index i = 0; i < W.cols(); ++i) {
      VectorXd column = VectorXd::Zero(W.rows());
      operator_.W().AddTimes(1.0, VectorXd::Unit(W.cols(), i), &column);
      W.col(i) = column;
      EXPECT_NEAR(operator_.W().Diagonal(i), W(i, i), 1e-12 * W(i, i));
    }
    return W;
  }
  /// Its rows contact by contact.
  MatrixXd WByContact() const {
    std::vector<Eigen::Index> order;
    for (const ContactRows& contact : operator_.rows()) {
      for (Eigen::Index axis = 0; axis < contact.size(); ++axis) {
        order.push_back(contact.normal + axis);
      }
    }
    const MatrixXd own = W();
    return MatrixXd::NullaryExpr(own.rows(), own.cols(), [&](Eigen::Index i, Eigen::Index j) {
      return own(order[static_cast<std::size_t>(i)], order[static_cast<std::size_t>(j)]);
    });
  }

  /// W as of another thread, but with half of A, so that it can be told from this one's.
  std::vector<DelassusOperator> Prepared(const std::vector<Contact>& contacts, double h) {
    NodeMatrix half = system_.A_ff();
    for (NodeBlock& value : half.values) value *= 0.5;
    half_.Analyze(half);
    EXPECT_TRUE(half_.Factorize(half));
    ContactColumns columns(system_);
    columns.Reset(factorization_, world_);
    columns.Extend(contacts);
    std::vector<DelassusOperator> prepared(columns.num_pieces());
    for (std::size_t piece = 0; piece < prepared.size(); ++piece) {
      prepared[piece].Reset(half_, h);
      prepared[piece].SetRows(columns.by_piece()[piece]);
    }
    return prepared;
  }

  const TetMesh mesh_ = RepeatMesh(
      MakeBlock(4, 3, 2, {0.02, 0.01, 0.01}, false),
      {Eigen::Isometry3d::Identity(), Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.05, 0.0))});
  const ElasticBody body_{mesh_, {338000.0, 0.45, 1080.0}};
  ImplicitEuler system_{body_, mesh_.mount_nodes};
  const int free_nodes_of_one_ = static_cast<int>(system_.free_nodes().size()) / 2;
  SparseCholesky factorization_;
  SparseCholesky half_;
  RigidWorld world_;
  ConstraintOperator operator_{system_};
};

// Bodies on bodies give way by 1e-7 of what they do more.
constexpr double kClose = 2e-7;

TEST_F(ConstraintOperatorTest, EveryKindAloneIsTheDenseW) {
  const std::vector<Contact> kinds = EveryKind();
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    SCOPED_TRACE(i);
    operator_.Reset(factorization_, world_, kTimeStep);
    operator_.SetContacts({kinds[i]});
    EXPECT_EQ(operator_.plain(), i == 0);
    ExpectNear(WByContact(), DenseW({kinds[i]}), kClose);
  }
}

TEST_F(ConstraintOperatorTest, AllTogetherAreTheDenseW) {
  operator_.SetContacts(EveryKind());
  EXPECT_FALSE(operator_.plain());
  EXPECT_TRUE(operator_.IsPlain(0));
  EXPECT_FALSE(operator_.IsPlain(1));
  EXPECT_EQ(operator_.num_rows(), 16);
  ExpectNear(WByContact(), DenseW(EveryKind()), kClose);
}

// One more contact every time, and directions that turn: only where columns are bound to the
// normals they came with may they not.
TEST_F(ConstraintOperatorTest, AppendedAndTurnedContactsAreTheDenseW) {
  std::vector<Contact> contacts;
  for (const Contact& contact : EveryKind()) {
    contacts.push_back(contact);
    for (std::size_t i = 0; i + 1 < contacts.size(); ++i) {
      if (operator_.IsPlain(i)) continue;
      contacts[i].normal = (contacts[i].normal + Vector3d(0.1, -0.05, 0.02)).normalized();
    }
    operator_.SetContacts(contacts);
    ExpectNear(WByContact(), DenseW(contacts), kClose);
  }
}

// The same on both blocks, in turns; then the blocks touch.
TEST_F(ConstraintOperatorTest, PiecesMeetInTheBodiesAlone) {
  std::vector<Contact> contacts;
  for (Contact contact : EveryKind()) {
    contacts.push_back(contact);
    if (contact.num_nodes == 0) continue;
    for (int k = 0; k < contact.num_nodes; ++k) {
      const std::size_t place = static_cast<std::size_t>(k);
      const int free = system_.FreeRow(contact.nodes[place]) / 3 + free_nodes_of_one_;
      contact.nodes[place] = system_.free_nodes()[static_cast<std::size_t>(free)];
    }
    contacts.push_back(contact);
  }
  operator_.SetContacts(contacts);
  EXPECT_EQ(operator_.num_rows(), 28);
  ExpectNear(WByContact(), DenseW(contacts), kClose);
  // Of both blocks, and of each contact between bodies.
  ASSERT_EQ(operator_.W().groups.size(), 4U);
  EXPECT_EQ(operator_.W().groups[0].size(), 12);
  EXPECT_EQ(operator_.W().groups[1].size(), 12);
  EXPECT_EQ(operator_.W().groups[2].size(), 3);
  EXPECT_EQ(operator_.W().groups[3].size(), 1);

  contacts.push_back(On({2, 4, 6, 3 + free_nodes_of_one_}, -1, {0.1, 0.5, 1.0}, 0.0));
  operator_.SetContacts(contacts);
  ExpectNear(WByContact(), DenseW(contacts), kClose);
  ASSERT_EQ(operator_.W().groups.size(), 3U);
  EXPECT_EQ(operator_.W().groups[0].size(), 25);
}

TEST_F(ConstraintOperatorTest, PlainContactsOfPiecesStandPieceByPiece) {
  std::vector<Contact> contacts;
  for (const int node : {1, 5, 9, 13}) {
    contacts.push_back(On({node}, kGround, {0.1, 0.0, 1.0}, 0.0));
    contacts.push_back(On({node + free_nodes_of_one_}, kGround, {0.0, 0.2, 1.0}, 0.0));
    operator_.SetContacts(contacts);  // two more every time
  }
  EXPECT_TRUE(operator_.plain());
  EXPECT_FALSE(operator_.W().coupled());
  ASSERT_EQ(operator_.W().groups.size(), 2U);
  EXPECT_EQ(operator_.W().groups[0].size(), 4);
  ExpectNear(WByContact(), DenseW(contacts), 1e-12);
}

TEST_F(ConstraintOperatorTest, WhatWasPreparedNeedsNoMoreWork) {
  const std::vector<Contact> plain{
      On({5}, kGround, {0.0, 0.3, 1.0}, 0.0),
      On({5 + free_nodes_of_one_}, kGround, {0.1, 0.0, 1.0}, 0.0),
      On({9}, kGround, {0.0, 0.2, 1.0}, 0.0),
  };
  const std::vector<Contact> with_friction{On({5}, kGround, {0.0, 0.3, 1.0}, 0.4),
                                           On({7, 9, 11}, kGround, {0.1, 0.0, 1.0}, 0.0)};
  for (const std::vector<Contact>& contacts : {plain, with_friction}) {
    std::vector<DelassusOperator> prepared = Prepared(contacts, kTimeStep);
    operator_.Reset(factorization_, world_, kTimeStep, &prepared);
    operator_.SetContacts(contacts);
    ExpectNear(WByContact(), 2.0 * DenseW(contacts), kClose);

    // Only once.
    operator_.Reset(factorization_, world_, kTimeStep);
    operator_.SetContacts(contacts);
    ExpectNear(WByContact(), DenseW(contacts), kClose);
  }
}

// Fewer, in another order, along other normals or with another time step.
TEST_F(ConstraintOperatorTest, WhatWasPreparedForOthersIsNotTaken) {
  const std::vector<Contact> contacts{On({5}, kGround, {0.0, 0.3, 1.0}, 0.0),
                                      On({7}, kGround, {0.0, 0.2, 1.0}, 0.0)};
  std::vector<Contact> turned = contacts;
  turned[1].normal = Vector3d::UnitZ();
  for (const std::vector<Contact>& others :
       {std::vector<Contact>{}, {contacts[0]}, {contacts[1], contacts[0]}, turned}) {
    std::vector<DelassusOperator> prepared = Prepared(contacts, kTimeStep);
    operator_.Reset(factorization_, world_, kTimeStep, &prepared);
    operator_.SetContacts(others);
    EXPECT_EQ(operator_.num_rows(), static_cast<Eigen::Index>(others.size()));
    if (!others.empty()) ExpectNear(WByContact(), DenseW(others), 1e-12);
  }
  std::vector<DelassusOperator> prepared = Prepared(contacts, 0.5 * kTimeStep);
  operator_.Reset(factorization_, world_, kTimeStep, &prepared);
  operator_.SetContacts(contacts);
  ExpectNear(WByContact(), DenseW(contacts), 1e-12);
}

// The next contacts join them, with columns of this thread's own.
TEST_F(ConstraintOperatorTest, MoreContactsJoinWhatWasPrepared) {
  std::vector<Contact> contacts{On({5}, kGround, {0.0, 0.3, 1.0}, 0.0),
                                On({7}, kGround, {0.0, 0.2, 1.0}, 0.0)};
  std::vector<DelassusOperator> prepared = Prepared(contacts, kTimeStep);
  operator_.Reset(factorization_, world_, kTimeStep, &prepared);
  for (const int node : {9, 9 + free_nodes_of_one_}) {
    contacts.push_back(On({node}, kGround, {0.1, 0.0, 1.0}, 0.0));
  }
  operator_.SetContacts(contacts);
  const MatrixXd W = WByContact();
  const MatrixXd expected = DenseW(contacts);
  ExpectNear(W.topLeftCorner(2, 2), 2.0 * expected.topLeftCorner(2, 2), 1e-12);
  ExpectNear(W.topRightCorner(2, 2), std::sqrt(2.0) * expected.topRightCorner(2, 2), 1e-12);
  ExpectNear(W.bottomRightCorner(2, 2), expected.bottomRightCorner(2, 2), 1e-12);
}

TEST_F(ConstraintOperatorTest, ForcesDoToGapsWhatWSays) {
  for (const bool plain : {true, false}) {
    SCOPED_TRACE(plain);
    std::vector<Contact> contacts = EveryKind();
    if (plain) contacts.resize(1);
    operator_.Reset(factorization_, world_, kTimeStep);
    operator_.SetContacts(contacts);
    const MatrixXd J = Jacobian(contacts);
    const Eigen::Index size = 3 * system_.num_free();
    const VectorXd lambda = VectorXd::LinSpaced(operator_.num_rows(), 0.5, 2.0);
    const SystemVector none{VectorXd::Zero(size), VectorXd::Zero(12)};

    SystemVector b = none;
    operator_.AddImpulses(lambda, &b);
    VectorXd stacked(size + 12);
    stacked << b.cup, b.bodies;
    ExpectNear(stacked, kTimeStep * J.transpose() * lambda, 1e-12);

    SystemVector y = none;
    operator_.AddForces(lambda, &y);
    SystemVector expected;
    factorization_.Eliminate(b.cup, &expected.cup);
    ExpectNear(y.cup, expected.cup, 1e-10);
    VectorXd changes;
    operator_.GapChanges(y, &changes);
    ExpectNear(changes, W() * lambda, kClose);
    VectorXd dv;
    factorization_.BackSubstitute(y.cup, &dv);
    stacked << dv, y.bodies;
    ExpectNear(changes, kTimeStep * J * stacked, 1e-10);
    if (plain) continue;
    operator_.BodyVelocities(b.bodies, &expected.bodies);
    ExpectNear(y.bodies, expected.bodies, 1e-12);
    operator_.BodyImpulses(y.bodies, &expected.bodies);
    ExpectNear(expected.bodies, b.bodies, 1e-12);
  }
}

// Past an edge a normal may turn by a right angle, into what was chosen as across it.
TEST_F(ConstraintOperatorTest, AxesAreOrthonormalWhateverIsAcross) {
  for (const Vector3d& normal : {Vector3d(1.0, 0.0, 0.0), Vector3d(1.0, 1e-9, 0.0),
                                 Vector3d(0.0, 1.0, 0.0), Vector3d(-1.0, 0.05, 0.0)}) {
    const Eigen::Matrix3d axes = ConstraintOperator::Axes(On({3}, kGround, normal, 0.5));
    EXPECT_TRUE((axes.transpose() * axes).isIdentity(1e-12));
    EXPECT_LT((axes.col(0) - normal.normalized()).norm(), 1e-12);
    EXPECT_NEAR(axes.determinant(), 1.0, 1e-12);
  }
}

TEST_F(ConstraintOperatorTest, NoContactsAreNoRows) {
  operator_.SetContacts({});
  EXPECT_TRUE(operator_.plain());
  EXPECT_EQ(operator_.num_rows(), 0);
  EXPECT_EQ(operator_.W().num_rows(), 0);
}

}  // namespace
}  // namespace vacuum_gripper_sim
