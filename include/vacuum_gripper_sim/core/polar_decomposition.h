#pragma once

#include <Eigen/Core>

namespace vacuum_gripper_sim {

/** Rotation R of the polar decomposition F = R S, the rotation nearest to F.

 Newton's iteration R <- (R + R^-T) / 2 ([Higham 1986]); where F is inverted or nearly singular, a
 singular value decomposition with the smallest singular value's sign turned, so that det R = +1
 always and an inverted element is pushed back through its flattest direction ([Irving 2004]).

 [Higham 1986] N. J. Higham, "Computing the polar decomposition - with applications", SIAM J. Sci.
   Stat. Comput. 7(4).
 [Irving 2004] G. Irving, J. Teran, R. Fedkiw, "Invertible finite elements for robust simulation of
   large deformation", SCA 2004. */
Eigen::Matrix3d RotationOf(const Eigen::Matrix3d& F);

}  // namespace vacuum_gripper_sim
