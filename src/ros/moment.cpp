#include "moment.h"

#include <cstddef>

namespace vacuum_gripper_sim {

void SetLabels(const std::vector<RigidObject>& objects, std::vector<ObjectLabel>* labels) {
  labels->resize(objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i) {
    (*labels)[i].name = objects[i].name;
    (*labels)[i].is_free = objects[i].inertia.has_value();
  }
}

}  // namespace vacuum_gripper_sim
