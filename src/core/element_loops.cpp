#include "vacuum_gripper_sim/core/element_loops.h"

#include <algorithm>
#include <numeric>
#include <type_traits>

namespace vacuum_gripper_sim {
namespace {

/// Work that is worth a call of the crew: integration points of packs.
constexpr std::size_t kWorthSharing = 200;

void GatherColumns(const Eigen::Matrix3Xd& values, const std::vector<int>& nodes,
                   Eigen::Matrix3Xd* gathered) {
  Eigen::Index next = 0;
  for (const int node : nodes) gathered->col(next++) = values.col(node);
}

template <typename Part>
void AddSums(const Part& part, Eigen::Matrix3Xd* target) {
  Eigen::Index next = 0;
  for (const int node : part.nodes) target->col(node) += part.sum.col(next++);
}

/// The crew, if the work is worth a call.
template <typename Parts>
Crew* Sharing(const Parts& parts, Crew* crew) {
  const auto& last = parts.back();
  const std::size_t num_points =
      (last.packs_before + last.packs.size()) * last.packs.front().weights.size();
  return num_points < kWorthSharing ? nullptr : crew;
}

/// sum -= (h P + factor dP(v)) dN/dX, integrated over one pack. @param[out] tangent Of the pack.
template <typename Element, typename Law>
void LinearizePack(const ElementPack<Element>& pack, const Law& law, const Eigen::Matrix3Xd& x,
                   const Eigen::Matrix3Xd& v, double h, double factor, Pack* tangent,
                   Eigen::Matrix3Xd* sum) {
  typename ElementPack<Element>::NodalVectors values;
  typename ElementPack<Element>::PointMatrices F, dF, P;
  pack.Gather(x, &values);
  pack.Gradients(values, &F);
  pack.Gather(v, &values);
  pack.Gradients(values, &dF);
  for (std::size_t q = 0; q < Element::kPoints; ++q, tangent += TangentSize(law)) {
    P[q] = Stress(law, F[q], tangent);
    const PackMatrix3 dP = StressChange(law, tangent, dF[q]);
    for (std::size_t k = 0; k < dP.size(); ++k) P[q][k] = h * P[q][k] + factor * dP[k];
  }
  pack.Divergence(P, -1.0, &values);
  pack.AddTo(values, sum);
}

/// sum += factor K u of one pack. @param tangent Of the pack.
template <typename Element, typename Law>
void AddStiffnessOfPack(const ElementPack<Element>& pack, const Law& law, const Pack* tangent,
                        double factor, const Eigen::Matrix3Xd& u, Eigen::Matrix3Xd* sum) {
  typename ElementPack<Element>::NodalVectors values;
  typename ElementPack<Element>::PointMatrices dF, dP;
  pack.Gather(u, &values);
  pack.Gradients(values, &dF);
  for (std::size_t q = 0; q < Element::kPoints; ++q, tangent += TangentSize(law)) {
    dP[q] = StressChange(law, tangent, dF[q]);
  }
  pack.Divergence(dP, factor, &values);
  pack.AddTo(values, sum);
}

/// The part's sum = factor K u of some of its packs.
template <typename Part, typename Law>
void SumStiffness(const std::vector<std::size_t>& packs, const std::vector<Pack>& tangents,
                  const Law& law, double factor, const Eigen::Matrix3Xd& u, Part* part) {
  using Element = typename Part::ElementType;
  GatherColumns(u, part->nodes, &part->x);
  part->sum.setZero();
  for (const std::size_t k : packs) {
    const Pack* const tangent =
        tangents.data() + TangentsBegin<Element>(part->packs_before + k, law);
    AddStiffnessOfPack(part->packs[k], law, tangent, factor, part->x, &part->sum);
  }
}

}  // namespace

template <typename Element>
ElementLoops::Parts<Element> ElementLoops::MakeParts(const std::vector<Element>& elements,
                                                     int num_nodes,
                                                     const std::vector<int>& clamped_nodes) {
  const std::size_t num_packs = (elements.size() + kPackLanes - 1) / kPackLanes;
  Parts<Element> parts(kElementParts);
  for (std::size_t p = 0; p < kElementParts; ++p) {
    Part<Element>& part = parts[p];
    part.packs_before = p * num_packs / kElementParts;
    const std::size_t packs_end = (p + 1) * num_packs / kElementParts;
    part.packs = MakeElementPacks(elements, part.packs_before * kPackLanes,
                                  std::min(packs_end * kPackLanes, elements.size()));
    part.all_packs.resize(part.packs.size());
    std::iota(part.all_packs.begin(), part.all_packs.end(), std::size_t{0});
    std::vector<int> place(static_cast<std::size_t>(num_nodes), -1);
    for (std::size_t k = 0; k < part.packs.size(); ++k) {
      bool is_clamped = false;
      for (auto& lanes : part.packs[k].nodes) {
        for (int& node : lanes) {
          is_clamped |= std::binary_search(clamped_nodes.begin(), clamped_nodes.end(), node);
          int& place_of_node = place[static_cast<std::size_t>(node)];
          if (place_of_node < 0) {
            place_of_node = static_cast<int>(part.nodes.size());
            part.nodes.push_back(node);
          }
          node = place_of_node;
        }
      }
      if (is_clamped) part.clamped_packs.push_back(k);
    }
    for (Eigen::Matrix3Xd* values : {&part.x, &part.v, &part.sum}) {
      values->resize(3, static_cast<Eigen::Index>(part.nodes.size()));
    }
  }
  return parts;
}

ElementLoops::ElementLoops(const ElasticBody& body, const std::vector<int>& clamped_nodes)
    : body_(&body) {
  std::visit(
      [&](const auto& elements) { parts_ = MakeParts(elements, body.num_nodes(), clamped_nodes); },
      body.elements());
}

void ElementLoops::Linearize(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& v, double h,
                             double stiffness_factor, std::vector<Pack>* tangents,
                             Eigen::Matrix3Xd* sum, Crew* crew) {
  sum->setZero(3, x.cols());
  std::visit(
      [&](auto& parts, const auto& law) {
        using Element = typename std::decay_t<decltype(parts.front())>::ElementType;
        const auto& last = parts.back();
        tangents->resize(TangentsBegin<Element>(last.packs_before + last.packs.size(), law));
        const auto linearize = [&](int p, int /*member*/) {
          auto& part = parts[static_cast<std::size_t>(p)];
          GatherColumns(x, part.nodes, &part.x);
          GatherColumns(v, part.nodes, &part.v);
          part.sum.setZero();
          for (const std::size_t k : part.all_packs) {
            Pack* const tangent =
                tangents->data() + TangentsBegin<Element>(part.packs_before + k, law);
            LinearizePack(part.packs[k], law, part.x, part.v, h, stiffness_factor, tangent,
                          &part.sum);
          }
        };
        Share(Sharing(parts, crew), static_cast<int>(parts.size()), linearize);
        for (const auto& part : parts) AddSums(part, sum);
      },
      parts_, body_->law());
}

void ElementLoops::AddStiffness(const std::vector<Pack>& tangents, double stiffness_factor,
                                const Eigen::Matrix3Xd& u, Eigen::Matrix3Xd* product, Crew* crew) {
  std::visit(
      [&](auto& parts, const auto& law) {
        const auto multiply = [&](int p, int /*member*/) {
          auto& part = parts[static_cast<std::size_t>(p)];
          SumStiffness(part.all_packs, tangents, law, stiffness_factor, u, &part);
        };
        Share(Sharing(parts, crew), static_cast<int>(parts.size()), multiply);
        for (const auto& part : parts) AddSums(part, product);
      },
      parts_, body_->law());
}

void ElementLoops::AddStiffnessOfClamped(const std::vector<Pack>& tangents, double stiffness_factor,
                                         const Eigen::Matrix3Xd& u, Eigen::Matrix3Xd* product) {
  std::visit(
      [&](auto& parts, const auto& law) {
        for (auto& part : parts) {
          if (part.clamped_packs.empty()) continue;
          SumStiffness(part.clamped_packs, tangents, law, stiffness_factor, u, &part);
          AddSums(part, product);
        }
      },
      parts_, body_->law());
}

}  // namespace vacuum_gripper_sim
