#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <cstddef>
#include <vector>

#include "vacuum_gripper_sim/core/contact_compliance.h"
#include "vacuum_gripper_sim/core/contact_factor.h"
#include "vacuum_gripper_sim/core/matrix_memory.h"

namespace vacuum_gripper_sim {

/// A contact that slides, near the force at which its projection is linearised: with z the
/// tangential force before projecting, lambda_t - delta_t / W_tt,
struct SlidingContact {
  Eigen::Index normal{0};
  Eigen::Index tangent{0};  ///< The first of two rows.
  double friction{0.0};     ///< mu. [-]
  double scale{0.0};        ///< W_tt. [m/N]
  Eigen::Vector2d d;        ///< z / |z|.
  Eigen::Matrix2d theta_P;  ///< mu lambda_n / |z| (1 - d d^T).
};

/** Contact forces for given gaps and slips delta without any, the state of each contact assumed:

     held rows            (delta + W lambda)_i = 0,
     sliding tangents     W_tt (lambda_t - mu lambda_n d) = theta P (W_tt lambda_t - (delta + W
                          lambda)_t),
     all others           lambda_i = 0.

 That is K lambda = -Q delta, K = S + Q C + Q U U^T with W's two parts, Q being 1 on held rows and
 theta P on sliding tangents. S + Q C falls into groups, each of which is eliminated by itself, held
 rows, symmetric, first; U's few columns are then closed up by the formula of [Woodbury 1950].

 [Woodbury 1950] M. A. Woodbury, "Inverting modified matrices", Memorandum Report 42, Statistical
   Research Group, Princeton. */
class LinearizedContacts {
 public:
  /// @param W Must outlive the forces that are asked for. @param held Rows; the normals of sliding
  /// contacts among them. @returns whether there is a solution; otherwise there are no forces.
  bool Compute(const ContactCompliance& W, const std::vector<Eigen::Index>& held,
               const std::vector<SlidingContact>& sliding);

  /// @param delta Of all rows. [m] @param[out] lambda Of all rows. [N]
  void Forces(const Eigen::VectorXd& delta, Eigen::VectorXd* lambda);

 private:
  /// Some rows of W: the group's own part of K, factorised.
  struct Group {
    const ContactCompliance::Group* own{nullptr};
    std::vector<Eigen::Index> held;  // rows of W
    std::vector<SlidingContact> sliding;
    ContactFactor C_EE;            // E: held, S: sliding tangents
    Eigen::MatrixXd inverse_C_ES;  // C_EE^-1 C_ES
    Eigen::MatrixXd B_SE, B_SS;
    Eigen::PartialPivLU<Eigen::MatrixXd> complement;  // of C_EE
  };
  static bool Factorize(Group* group);
  template <typename Matrix>
  void ApplyQ(Matrix* values) const;
  template <typename Matrix>
  void SolveGroups(Matrix* values);
  void Solve(Eigen::VectorXd* values);
  void FindResidual(const Eigen::VectorXd& lambda);

  const ContactCompliance* W_{nullptr};
  std::vector<Group> groups_;                         // of W's, in their order
  ContactCompliance::RowMajorMatrix inverse_QU_;      // (S + Q C)^-1 Q U
  Eigen::MatrixXd UT_inverse_QU_;                     // and 1 on its diagonal
  Eigen::PartialPivLU<Eigen::MatrixXd> capacitance_;  // 1 + U^T (S + Q C)^-1 Q U
  // Of Forces().
  Eigen::VectorXd right_, residual_;
  Eigen::VectorXd UT_forces_, moved_;
  MatrixMemory<double> forces_E_, right_S_, forces_S_;
};

}  // namespace vacuum_gripper_sim
