#include "vacuum_gripper_sim/config/objects_writer.h"

#include <cstddef>
#include <locale>

namespace vacuum_gripper_sim {
namespace {

constexpr int kDigits = 12;

/// A field as RFC 4180 has it.
std::string Field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) {
    if (c == '"') field += c;
    field += c;
  }
  return field + '"';
}

void WriteVector(const Eigen::Vector3d& v, std::ostream* stream) {
  *stream << ',' << v.x() << ',' << v.y() << ',' << v.z();
}

}  // namespace

ObjectsWriter::ObjectsWriter(const std::vector<RigidObject>& objects, std::ostream* stream)
    : stream_(stream) {
  for (const RigidObject& object : objects) names_.push_back(Field(object.name));
  stream_->imbue(std::locale::classic());
  stream_->precision(kDigits);
  *stream_
      << "time,name,x,y,z,qx,qy,qz,qw,velocity_x,velocity_y,velocity_z,force_x,force_y,force_z,"
         "torque_x,torque_y,torque_z\n";
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
