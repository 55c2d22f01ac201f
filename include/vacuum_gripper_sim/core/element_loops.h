#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <variant>
#include <vector>

#include "vacuum_gripper_sim/core/crew.h"
#include "vacuum_gripper_sim/core/elastic_body.h"
#include "vacuum_gripper_sim/core/element_pack.h"

namespace vacuum_gripper_sim {

/** Sums over the elements of a body, without a matrix and in vector registers.

 Elements are visited in a few parts of neighbours, each of which sums up at its own copies of the
 nodes, so that threads can share the work; the numbers are the same with any. */
class ElementLoops {
 public:
  /// @param body Must outlive this. @param clamped_nodes Whose elements can be visited alone.
  ElementLoops(const ElasticBody& body, const std::vector<int>& clamped_nodes);

  /** Impulses of stress and stiffness, sum of -(h P(x) + c dP(x; v)) dN/dX integrated.
   @param x,v Positions [m] and velocities [m/s], 3 by #nodes. @param h Time step. [s]
   @param stiffness_factor c. [s^2]
   @param[out] tangents Of the law, see TangentsBegin().
   @param[out] sum 3 by #nodes. [N s] @param crew Shares the work; none: this thread alone. */
  void Linearize(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& v, double h,
                 double stiffness_factor, std::vector<Pack>* tangents, Eigen::Matrix3Xd* sum,
                 Crew* crew);

  /// product += c K u. @param tangents Of K. @param u,product 3 by #nodes.
  void AddStiffness(const std::vector<Pack>& tangents, double stiffness_factor,
                    const Eigen::Matrix3Xd& u, Eigen::Matrix3Xd* product, Crew* crew);
  /// The same by the elements with clamped nodes alone: all of it at these nodes.
  void AddStiffnessOfClamped(const std::vector<Pack>& tangents, double stiffness_factor,
                             const Eigen::Matrix3Xd& u, Eigen::Matrix3Xd* product);

 private:
  /// Some packs; their nodes are places in `nodes`.
  template <typename Element>
  struct Part {
    using ElementType = Element;
    std::vector<ElementPack<Element>> packs;
    std::vector<std::size_t> all_packs, clamped_packs;  ///< The latter with clamped nodes.
    std::size_t packs_before{0};                        ///< In other parts.
    std::vector<int> nodes;                             ///< Of the mesh.
    Eigen::Matrix3Xd x, v, sum;                         ///< At these.
  };
  template <typename Element>
  using Parts = std::vector<Part<Element>>;

  template <typename Element>
  static Parts<Element> MakeParts(const std::vector<Element>& elements, int num_nodes,
                                  const std::vector<int>& clamped_nodes);

  const ElasticBody* body_;
  std::variant<Parts<LinearTetrahedron>, Parts<QuadraticTetrahedron>> parts_;
};

}  // namespace vacuum_gripper_sim
