#include "vacuum_gripper_sim/core/element_pack.h"

#include <algorithm>
#include <cstddef>

namespace vacuum_gripper_sim {
namespace {

template <typename Element>
using NodalVectors = typename ElementPack<Element>::NodalVectors;
template <typename Element>
using PointMatrices = typename ElementPack<Element>::PointMatrices;

// v = sum of L_a v_a: entry (i, a) of its gradient by L1 .. L3, where L0 is one less the others, is
// that of dv/dL_a - dv/dL_0.
void LocalGradients(const NodalVectors<LinearTetrahedron>& v, PointMatrices<LinearTetrahedron>* H) {
  for (std::size_t a = 1; a < 4; ++a) {
    for (std::size_t i = 0; i < 3; ++i) (*H)[0][i + 3 * (a - 1)] = v[a][i] - v[0][i];
  }
}

/// Transposed.
void LocalDivergence(const PointMatrices<LinearTetrahedron>& T,
                     NodalVectors<LinearTetrahedron>* sum) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t a = 1; a < 4; ++a) (*sum)[a][i] = T[0][i + 3 * (a - 1)];
    (*sum)[0][i] = -(T[0][i] + T[0][i + 3] + T[0][i + 6]);
  }
}

// Ten nodes: v_aa at corner a, v_ab = v_ba between the corners a and b, so that
//
//     v = sum_a L_a (2 L_a - 1) v_aa + sum_{a<b} 4 L_a L_b v_ab,
//     dv/dL_a = 4 sum_b L_b v_ab - v_aa.
//
// At the point near corner q, L_q = 1 - 3 f and all others are f: the sum is the same at all points
// but for (1 - 4 f) v_aq.
constexpr std::size_t kNode[4][4] = {{0, 4, 6, 7}, {4, 1, 5, 8}, {6, 5, 2, 9}, {7, 8, 9, 3}};
constexpr double kFar = 4.0 * kFarCoordinate;
constexpr double kNear = 4.0 * (1.0 - 4.0 * kFarCoordinate);

void LocalGradients(const NodalVectors<QuadraticTetrahedron>& v,
                    PointMatrices<QuadraticTetrahedron>* H) {
  for (std::size_t i = 0; i < 3; ++i) {
    std::array<Pack, 4> common;
    for (std::size_t a = 0; a < 4; ++a) {
      const auto& node = kNode[a];
      common[a] = kFar * (v[node[0]][i] + v[node[1]][i] + v[node[2]][i] + v[node[3]][i]) - v[a][i];
    }
    for (std::size_t a = 1; a < 4; ++a) {
      const Pack difference = common[a] - common[0];
      for (std::size_t q = 0; q < 4; ++q) {
        (*H)[q][i + 3 * (a - 1)] = difference + kNear * (v[kNode[a][q]][i] - v[kNode[0][q]][i]);
      }
    }
  }
}

/// Transposed.
void LocalDivergence(const PointMatrices<QuadraticTetrahedron>& T,
                     NodalVectors<QuadraticTetrahedron>* sum) {
  for (std::size_t i = 0; i < 3; ++i) {
    std::array<std::array<Pack, 4>, 4> t;  // by a and q
    for (std::size_t q = 0; q < 4; ++q) {
      for (std::size_t a = 1; a < 4; ++a) t[a][q] = T[q][i + 3 * (a - 1)];
      t[0][q] = -(t[1][q] + t[2][q] + t[3][q]);
    }
    std::array<Pack, 4> total;
    for (std::size_t a = 0; a < 4; ++a) total[a] = t[a][0] + t[a][1] + t[a][2] + t[a][3];
    for (std::size_t a = 0; a < 4; ++a) {
      (*sum)[a][i] = (kFar - 1.0) * total[a] + kNear * t[a][a];
      for (std::size_t b = 0; b < a; ++b) {
        (*sum)[kNode[a][b]][i] = kFar * (total[a] + total[b]) + kNear * (t[a][b] + t[b][a]);
      }
    }
  }
}

}  // namespace

template <typename Element>
void ElementPack<Element>::Gather(const Eigen::Matrix3Xd& values, NodalVectors* gathered) const {
  for (std::size_t a = 0; a < Element::kNodes; ++a) {
    for (int lane = 0; lane < kPackLanes; ++lane) {
      const double* const value = values.col(nodes[a][static_cast<std::size_t>(lane)]).data();
      for (std::size_t i = 0; i < 3; ++i) (*gathered)[a][i](lane) = value[i];
    }
  }
}

template <typename Element>
void ElementPack<Element>::Gradients(const NodalVectors& values, PointMatrices* gradients) const {
  PointMatrices H;
  LocalGradients(values, &H);
  for (std::size_t q = 0; q < Element::kPoints; ++q) {
    for (std::size_t j = 0; j < 3; ++j) {
      const Pack* const dL = &dL_dX[q][3 * j];
      for (std::size_t i = 0; i < 3; ++i) {
        (*gradients)[q][i + 3 * j] = H[q][i] * dL[0] + H[q][i + 3] * dL[1] + H[q][i + 6] * dL[2];
      }
    }
  }
}

template <typename Element>
void ElementPack<Element>::Divergence(const PointMatrices& P, double factor,
                                      NodalVectors* divergence) const {
  PointMatrices T;
  for (std::size_t q = 0; q < Element::kPoints; ++q) {
    const Pack scale = factor * weights[q];
    for (std::size_t a = 0; a < 3; ++a) {
      const Pack* const dL = &dL_dX[q][a];
      for (std::size_t i = 0; i < 3; ++i) {
        T[q][i + 3 * a] = scale * (P[q][i] * dL[0] + P[q][i + 3] * dL[3] + P[q][i + 6] * dL[6]);
      }
    }
  }
  LocalDivergence(T, divergence);
}

template <typename Element>
void ElementPack<Element>::AddTo(const NodalVectors& values, Eigen::Matrix3Xd* target) const {
  for (std::size_t a = 0; a < Element::kNodes; ++a) {
    for (int lane = 0; lane < kPackLanes; ++lane) {
      double* const sum = target->col(nodes[a][static_cast<std::size_t>(lane)]).data();
      for (std::size_t i = 0; i < 3; ++i) sum[i] += values[a][i](lane);
    }
  }
}

template <typename Element>
std::vector<ElementPack<Element>> MakeElementPacks(const std::vector<Element>& elements,
                                                   std::size_t begin, std::size_t end) {
  std::vector<ElementPack<Element>> packs;
  for (; begin < end; begin += kPackLanes) {
    ElementPack<Element>& pack = packs.emplace_back();
    for (int lane = 0; lane < kPackLanes; ++lane) {
      const std::size_t e = begin + static_cast<std::size_t>(lane);
      const Element& element = elements[std::min(e, end - 1)];
      for (std::size_t a = 0; a < Element::kNodes; ++a) {
        pack.nodes[a][static_cast<std::size_t>(lane)] = element.nodes[a];
      }
      for (std::size_t q = 0; q < Element::kPoints; ++q) {
        pack.weights[q](lane) = e < end ? element.weights[q] : 0.0;
        for (std::size_t k = 0; k < 9; ++k) pack.dL_dX[q][k](lane) = element.dL_dX[q].data()[k];
      }
    }
  }
  return packs;
}

template struct ElementPack<LinearTetrahedron>;
template struct ElementPack<QuadraticTetrahedron>;
template std::vector<ElementPack<LinearTetrahedron>> MakeElementPacks(
    const std::vector<LinearTetrahedron>&, std::size_t, std::size_t);
template std::vector<ElementPack<QuadraticTetrahedron>> MakeElementPacks(
    const std::vector<QuadraticTetrahedron>&, std::size_t, std::size_t);

}  // namespace vacuum_gripper_sim
