#include "vacuum_gripper_sim/core/implicit_euler.h"

#include <algorithm>

namespace vacuum_gripper_sim {
namespace {

/// Offset of entry (row, column) in the value array of a compressed column-major matrix.
int OffsetOf(const Eigen::SparseMatrix<double>& matrix, int row, int column) {
  const int* begin = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column];
  const int* end = matrix.innerIndexPtr() + matrix.outerIndexPtr()[column + 1];
  return static_cast<int>(std::lower_bound(begin, end, row) - matrix.innerIndexPtr());
}

}  // namespace

ImplicitEuler::ImplicitEuler(const ElasticBody& body, const std::vector<int>& clamped_nodes)
    : body_(&body),
      clamped_nodes_(clamped_nodes),
      free_row_(static_cast<std::size_t>(body.num_nodes()), -1),
      clamped_row_(static_cast<std::size_t>(body.num_nodes()), -1) {
  for (std::size_t i = 0; i < clamped_nodes_.size(); ++i) {
    clamped_row_[static_cast<std::size_t>(clamped_nodes_[i])] = 3 * static_cast<int>(i);
  }
  for (int node = 0; node < body.num_nodes(); ++node) {
    if (clamped_row_[static_cast<std::size_t>(node)] >= 0) continue;
    free_row_[static_cast<std::size_t>(node)] = 3 * num_free();
    free_nodes_.push_back(node);
  }
  FindSparsity();
  MapBlocks();
}

void ImplicitEuler::FindSparsity() {
  std::vector<Eigen::Triplet<double>> free_entries;
  std::vector<Eigen::Triplet<double>> coupling_entries;
  const auto add_block = [&](int row_node, int column_node) {
    const int column = free_row_[static_cast<std::size_t>(column_node)];
    if (column < 0) return;
    const int free_row = free_row_[static_cast<std::size_t>(row_node)];
    const int clamped_row = clamped_row_[static_cast<std::size_t>(row_node)];
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) {
        if (free_row < 0) {
          coupling_entries.emplace_back(clamped_row + i, column + j, 0.0);
        } else if (free_row + i >= column + j) {
          free_entries.emplace_back(free_row + i, column + j, 0.0);
        }
      }
    }
  };
  std::visit(
      [&](const auto& elements) {
        for (const auto& element : elements) {
          for (const int a : element.nodes) {
            for (const int b : element.nodes) add_block(a, b);
          }
        }
      },
      body_->elements());
  const int free_size = 3 * num_free();
  const int clamped_size = 3 * static_cast<int>(clamped_nodes_.size());
  A_ff_.resize(free_size, free_size);
  A_ff_.setFromTriplets(free_entries.begin(), free_entries.end());
  A_cf_.resize(clamped_size, free_size);
  A_cf_.setFromTriplets(coupling_entries.begin(), coupling_entries.end());
  A_cc_.resize(clamped_size, clamped_size);
}

void ImplicitEuler::MapBlocks() {
  using Matrix = BlockTarget::Matrix;
  const auto target_of = [&](int row_node, int column_node) {
    BlockTarget target;
    const int free_row = free_row_[static_cast<std::size_t>(row_node)];
    const int free_column = free_row_[static_cast<std::size_t>(column_node)];
    const int clamped_row = clamped_row_[static_cast<std::size_t>(row_node)];
    const int clamped_column = clamped_row_[static_cast<std::size_t>(column_node)];
    for (int j = 0; j < 3; ++j) {
      int& offset = target.offsets[static_cast<std::size_t>(j)];
      if (free_row >= 0 && free_row == free_column) {
        target.matrix = Matrix::kFreeDiagonal;
        offset = OffsetOf(A_ff_, free_row + j, free_column + j);
      } else if (free_row > free_column && free_column >= 0) {
        target.matrix = Matrix::kFreeLower;
        offset = OffsetOf(A_ff_, free_row, free_column + j);
      } else if (free_row < 0 && free_column >= 0) {
        target.matrix = Matrix::kClampedFree;
        offset = OffsetOf(A_cf_, clamped_row, free_column + j);
      } else if (free_row < 0) {
        target.matrix = Matrix::kClamped;
        offset = clamped_row + (clamped_column + j) * static_cast<int>(A_cc_.rows());
      }
    }
    return target;
  };
  std::visit(
      [&](const auto& elements) {
        for (const auto& element : elements) {
          for (const int a : element.nodes) {
            for (const int b : element.nodes) targets_.push_back(target_of(a, b));
          }
        }
      },
      body_->elements());
  mass_offsets_.resize(static_cast<std::size_t>(A_ff_.cols()));
  for (int row = 0; row < A_ff_.cols(); ++row) {
    mass_offsets_[static_cast<std::size_t>(row)] = OffsetOf(A_ff_, row, row);
  }
}

template <typename Element>
void ImplicitEuler::AddBlocks(const typename Element::Stiffness& K_e, double factor,
                              const BlockTarget* targets) {
  double* const free_values = A_ff_.valuePtr();
  double* const coupling_values = A_cf_.valuePtr();
  double* const clamped_values = A_cc_.data();
  for (int a = 0; a < Element::kNodes; ++a) {
    for (int b = 0; b < Element::kNodes; ++b) {
      const BlockTarget& target = targets[a * Element::kNodes + b];
      if (target.matrix == BlockTarget::Matrix::kNone) continue;
      const Eigen::Matrix3d block = factor * Element::Block(K_e, a, b);
      const bool diagonal = target.matrix == BlockTarget::Matrix::kFreeDiagonal;
      double* const values = target.matrix == BlockTarget::Matrix::kClampedFree ? coupling_values
                             : target.matrix == BlockTarget::Matrix::kClamped   ? clamped_values
                                                                                : free_values;
      for (int j = 0; j < 3; ++j) {
        const int first = diagonal ? j : 0;  // the diagonal block's lower triangle
        double* column = values + target.offsets[static_cast<std::size_t>(j)];
        for (int i = first; i < 3; ++i) column[i - first] += block(i, j);
      }
    }
  }
}

template <typename Element, typename Law>
void ImplicitEuler::AddElements(const std::vector<Element>& elements, const Law& law,
                                const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& v, double h,
                                double beta) {
  using NodalVectors = typename Element::NodalVectors;
  using Stacked = Eigen::Matrix<double, NodalVectors::SizeAtCompileTime, 1>;
  NodalVectors f_e;
  NodalVectors K_v;
  typename Element::Stiffness K_e;
  const BlockTarget* targets = targets_.data();
  const double factor = h * beta + h * h;
  for (const Element& element : elements) {
    ElementForces(element, law, element.Gather(x), &f_e, &K_e);
    AddBlocks<Element>(K_e, factor, targets);
    targets += Element::kNodes * Element::kNodes;

    const NodalVectors v_e = element.Gather(v);
    Eigen::Map<Stacked>(K_v.data()).noalias() = K_e * Eigen::Map<const Stacked>(v_e.data());
    f_e = h * f_e - factor * K_v;
    for (int a = 0; a < Element::kNodes; ++a) {
      b_.col(element.nodes[static_cast<std::size_t>(a)]) += f_e.row(a).transpose();
    }
  }
}

void ImplicitEuler::AddMasses(const Eigen::Matrix3Xd& v, double h, double alpha,
                              const Eigen::Vector3d& gravity) {
  for (int node = 0; node < v.cols(); ++node) {
    const double mass = body_->masses()(node);
    b_.col(node) += h * (body_->weights()(node) * gravity - alpha * mass * v.col(node));
    const double diagonal = (1.0 + h * alpha) * mass;
    const int free_row = FreeRow(node);
    const int clamped_row = clamped_row_[static_cast<std::size_t>(node)];
    for (int i = 0; i < 3; ++i) {
      if (free_row >= 0) {
        A_ff_.valuePtr()[mass_offsets_[static_cast<std::size_t>(free_row + i)]] += diagonal;
      } else {
        A_cc_(clamped_row + i, clamped_row + i) += diagonal;
      }
    }
  }
}

void ImplicitEuler::Linearize(const Eigen::Matrix3Xd& x, const Eigen::Matrix3Xd& v, double h,
                              const RayleighDamping& damping, const Eigen::Vector3d& gravity) {
  h_ = h;
  std::fill_n(A_ff_.valuePtr(), A_ff_.nonZeros(), 0.0);
  std::fill_n(A_cf_.valuePtr(), A_cf_.nonZeros(), 0.0);
  A_cc_.setZero();
  b_.setZero(3, x.cols());
  std::visit([&](const auto& elements,
                 const auto& law) { AddElements(elements, law, x, v, h, damping.stiffness); },
             body_->elements(), body_->law());
  AddMasses(v, h, damping.mass, gravity);
}

Eigen::VectorXd ImplicitEuler::FreeRightHandSide(const Eigen::Matrix3Xd& dv_c) const {
  const Eigen::Map<const Eigen::VectorXd> stacked(dv_c.data(), dv_c.size());
  return GatherFree(b_) - A_cf_.transpose() * stacked;
}

Eigen::Matrix3Xd ImplicitEuler::ClampedReaction(const Eigen::VectorXd& dv_f,
                                                const Eigen::Matrix3Xd& dv_c) const {
  const Eigen::Map<const Eigen::VectorXd> stacked(dv_c.data(), dv_c.size());
  const Eigen::VectorXd product = A_cf_ * dv_f + A_cc_ * stacked;
  Eigen::Matrix3Xd reaction(3, dv_c.cols());
  for (Eigen::Index i = 0; i < dv_c.cols(); ++i) {
    const auto b_i = b_.col(clamped_nodes_[static_cast<std::size_t>(i)]);
    reaction.col(i) = (product.segment<3>(3 * i) - b_i) / h_;
  }
  return reaction;
}

Eigen::VectorXd ImplicitEuler::GatherFree(const Eigen::Matrix3Xd& values) const {
  Eigen::VectorXd gathered(3 * num_free());
  for (int i = 0; i < num_free(); ++i) {
    gathered.segment<3>(3 * i) = values.col(free_nodes_[static_cast<std::size_t>(i)]);
  }
  return gathered;
}

Eigen::Matrix3Xd ImplicitEuler::Scatter(const Eigen::VectorXd& values_f,
                                        const Eigen::Matrix3Xd& values_c) const {
  Eigen::Matrix3Xd scattered(3, body_->num_nodes());
  for (int i = 0; i < num_free(); ++i) {
    scattered.col(free_nodes_[static_cast<std::size_t>(i)]) = values_f.segment<3>(3 * i);
  }
  for (std::size_t i = 0; i < clamped_nodes_.size(); ++i) {
    scattered.col(clamped_nodes_[i]) = values_c.col(static_cast<Eigen::Index>(i));
  }
  return scattered;
}

}  // namespace vacuum_gripper_sim
