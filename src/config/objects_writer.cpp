#include "vacuum_gripper_sim/config/objects_writer.h"

#include <cstddef>

#include "csv_text.h"

namespace vacuum_gripper_sim {
ObjectsWriter::ObjectsWriter(const std::vector<RigidObject>& objects, std::ostream* stream)
    : stream_(stream) {
  for (const RigidObject& object : objects) names_.push_back(CsvCell(object.name));
  BeginCsv(
      "time,name,x,y,z,qx,qy,qz,qw,velocity_x,velocity_y,velocity_z,force_x,force_y,force_z,"
      "torque_x,torque_y,torque_z",
      stream_);
}

void ObjectsWriter::Write(const StepResult& result) {
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const ObjectResult& object = result.objects.at(i);
    const Eigen::Quaterniond q = Eigen::Quaterniond(object.X_WO.linear()).normalized();
    *stream_ << result.time << ',' << names_[i];
    WriteVector(object.X_WO.translation(), stream_);
    *stream_ << ',' << q.x() << ',' << q.y() << ',' << q.z() << ',' << q.w();
    WriteVector(object.velocity_W, stream_);
    WriteVector(object.force_W, stream_);
    WriteVector(object.torque_W, stream_);
    *stream_ << '\n';
  }
}

}  // namespace vacuum_gripper_sim
