#pragma once

#include <Eigen/Core>
#include <vector>

namespace vacuum_gripper_sim {

/// A 3 by 3 block. A fourth row of zeros pads its columns to whole vector registers.
using NodeBlock = Eigen::Matrix<double, 4, 3>;

/// A symmetric matrix made of 3 by 3 blocks, a row and a column of them for each node. Of a block
/// and its mirror image one is stored.
struct NodeMatrix {
  struct Place {
    int row{0};
    int column{0};
  };

  int num_nodes{0};
  std::vector<Place> places;      ///< In any order. Blocks at the same place add up.
  std::vector<NodeBlock> values;  ///< By place.
};

}  // namespace vacuum_gripper_sim
