#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <locale>
#include <sstream>
#include <string>
#include <vector>

#include "config_test_tools.h"
#include "vacuum_gripper_sim/config/cups_writer.h"
#include "vacuum_gripper_sim/config/objects_writer.h"
#include "vacuum_gripper_sim/config/timeseries_writer.h"
#include "vacuum_gripper_sim/config/vtu_writer.h"
#include "vacuum_gripper_sim/core/simulator.h"

namespace vacuum_gripper_sim {
namespace {

/// Decimal comma and thousands separators, whatever locales the machine has.
class CommaPunctuation : public std::numpunct<char> {
 protected:
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

std::vector<std::string> Split(const std::string& line) {
  std::vector<std::string> words;
  std::istringstream stream(line);
  for (std::string word; std::getline(stream, word, ',');) words.push_back(word);
  return words;
}

TEST(TimeseriesWriter, RowMatchesHeader) {
  std::ostringstream text;
  text.imbue(std::locale(std::locale::classic(), new CommaPunctuation));
  TimeseriesWriter writer(&text);
  StepResult result;
  result.time = 1234.5678901;
  result.X_WM.linear() = Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0).toRotationMatrix();  // z down
  result.X_WM.translation() = Eigen::Vector3d(0.1, 0.2, 0.3);
  result.force_M = Eigen::Vector3d(1.0, 2.0, 3.0);
  result.torque_M = Eigen::Vector3d(4.0, 5.0, 6.0);
  result.status = SealStatus::kLost;
  result.setpoint = -6000.0;
  result.gauge_pressure = -1234567.25;
  result.num_contacts = 42;
  result.timings.total = 0.0025;
  result.zone_counts = {1, 2, 3, 4, 5};
  writer.Write(result);

  std::istringstream lines(text.str());
  std::string header, row;
  std::getline(lines, header);
  std::getline(lines, row);
  EXPECT_EQ(header.find("time,mount_x,mount_y,mount_z,setpoint,pressure,status,force_x,force_y,"
                        "force_z,torque_x,torque_y,torque_z,contacts,cavity_area,contact_force,"
                        "iterations,residual,step_ms,"),
            0U);
  const std::vector<std::string> names = Split(header);
  const std::vector<std::string> values = Split(row);
  ASSERT_EQ(names.size(), values.size());
  const auto value = [&](const std::string& name) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i] == name) return std::stod(values[i]);
    }
    return std::numeric_limits<double>::quiet_NaN();
  };
  EXPECT_EQ(value("time"), 1234.5678901);
  EXPECT_EQ(value("mount_z"), 0.3);
  EXPECT_EQ(value("setpoint"), -6000.0);
  EXPECT_EQ(value("pressure"), -1234567.25);
  EXPECT_EQ(value("status"), 3.0);
  // Half a turn about x: y and z change sign on the way to world axes.
  EXPECT_EQ(value("force_x"), 1.0);
  EXPECT_EQ(value("force_y"), -2.0);
  EXPECT_EQ(value("force_z"), -3.0);
  EXPECT_EQ(value("torque_z"), -6.0);
  EXPECT_EQ(value("contacts"), 42.0);
  EXPECT_EQ(value("step_ms"), 2.5);
  EXPECT_EQ(value("zone_4"), 5.0);
}

/// One tetrahedron of 10 cm, its lower face the cavity, its top node the mount.
TetMesh OneTet() {
  TetMesh mesh;
  mesh.source = "test";
  mesh.nodes.resize(3, 4);
  mesh.nodes << 0.0, 0.1, 0.0, 0.0,  //
      0.0, 0.0, 0.1, 0.0,            //
      0.0, 0.0, 0.0, 0.1;
  mesh.elements.resize(4, 1);
  mesh.elements << 0, 1, 2, 3;
  mesh.cavity_faces.resize(3, 1);
  mesh.cavity_faces << 0, 2, 1;
  mesh.mount_nodes = {3};
  return mesh;
}

std::vector<double> Numbers(const std::string& xml, const std::string& name) {
  const std::size_t begin = xml.find('>', xml.find("Name=\"" + name + "\"")) + 1;
  std::istringstream stream(xml.substr(begin, xml.find('<', begin) - begin));
  std::vector<double> numbers;
  for (double number; stream >> number;) numbers.push_back(number);
  return numbers;
}

TEST(ObjectsWriter, ARowForEveryObject) {
  std::vector<RigidObject> objects(2);
  objects[0].name = "table";
  objects[1].name = "a \"box\", closed";
  std::ostringstream text;
  text.imbue(std::locale(std::locale::classic(), new CommaPunctuation));
  ObjectsWriter writer(objects, &text);
  StepResult result;
  result.time = 1234.5;
  result.objects.resize(2);
  result.objects[0].X_WO.linear() = Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0).toRotationMatrix();
  result.objects[0].X_WO.translation() = Eigen::Vector3d(1.0, 2.0, 3.0);
  result.objects[0].velocity_W = Eigen::Vector3d(4.0, 5.0, 6.0);
  result.objects[0].force_W = Eigen::Vector3d(7.0, 8.0, 9.0);
  result.objects[0].torque_W = Eigen::Vector3d(10.0, 11.0, 12.0);
  writer.Write(result);

  std::istringstream lines(text.str());
  std::string header, first, second;
  std::getline(lines, header);
  std::getline(lines, first);
  std::getline(lines, second);
  EXPECT_EQ(Split(header).size(), 18U);
  EXPECT_EQ(first, "1234.5,table,1,2,3,1,0,0,0,4,5,6,7,8,9,10,11,12");
  EXPECT_EQ(second.substr(0, 27), "1234.5,\"a \"\"box\"\", closed\",");
}

TEST(CupsWriter, ARowForEveryCup) {
  std::vector<CupMount> cups(2);
  cups[0].name = "left";
  cups[1].name = "right";
  std::ostringstream text;
  text.imbue(std::locale(std::locale::classic(), new CommaPunctuation));
  CupsWriter writer(cups, &text);
  StepResult result;
  result.time = 1234.5;
  result.cups.resize(2);
  CupResult& left = result.cups[0];
  left.status = SealStatus::kLeaking;
  left.gauge_pressure = -6000.5;
  left.cavity_area = 1.0;
  left.contact_force = 2.0;
  left.num_contacts = 3;
  left.X_WC.linear() = Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0).toRotationMatrix();  // z down
  left.force_C = Eigen::Vector3d(4.0, 5.0, 6.0);
  left.torque_C = Eigen::Vector3d(7.0, 8.0, 9.0);
  left.bottleneck_gap = 10.0;
  left.opening = {11.0, 12.0, 13.0};
  left.cavity_volume = 14.0;
  left.leak_flow = 15.0;
  left.leak_area = 16.0;
  writer.Write(result);

  std::istringstream lines(text.str());
  std::string header, first, second;
  std::getline(lines, header);
  std::getline(lines, first);
  std::getline(lines, second);
  EXPECT_EQ(Split(header).size(), 20U);
  EXPECT_EQ(first, "1234.5,left,4,-6000.5,1,2,3,4,-5,-6,7,-8,-9,10,11,12,13,14,15,16");
  EXPECT_EQ(second.substr(0, 13), "1234.5,right,");
}

TEST(VtuWriter, WritesPointsCellsAndFields) {
  CupArray cups;
  cups.mesh = OneTet();
  cups.cavities.nodes = {0, 1, 2};
  cups.rest_M = MountFromRest(cups.mesh) * cups.mesh.nodes;
  StepResult result;
  result.X_WM.translation() = Eigen::Vector3d(1.0, 2.0, 3.0);
  result.x_W = result.X_WM * cups.rest_M;
  const Eigen::Vector3d moved(0.001, -0.002, 0.003);
  result.x_W.col(1) += moved;
  result.gap = {0.5, -1e-9, std::numeric_limits<double>::infinity()};
  result.classification.zones = {Zone::kStrictlyOutside, Zone::kInActiveContact,
                                 Zone::kStrictlyInside};
  std::ostringstream text;
  WriteVtu(cups, result, &text);
  const std::string xml = text.str();
  EXPECT_TRUE(Contains(xml, "NumberOfPoints=\"4\" NumberOfCells=\"1\""));
  EXPECT_EQ(Numbers(xml, "connectivity"), (std::vector<double>{0, 1, 2, 3}));
  EXPECT_EQ(Numbers(xml, "offsets"), (std::vector<double>{4}));
  EXPECT_EQ(Numbers(xml, "types"), (std::vector<double>{10}));
  EXPECT_EQ(Numbers(xml, "zone"), (std::vector<double>{0, 2, 4, -1}));
  EXPECT_EQ(Numbers(xml, "gap"), (std::vector<double>{0.5, -1e-9, kNoGap, kNoGap}));
  const std::vector<double> points = Numbers(xml, "Points");
  const std::vector<double> displacement = Numbers(xml, "displacement");
  ASSERT_EQ(points.size(), 12U);
  ASSERT_EQ(displacement.size(), 12U);
  for (std::size_t i = 0; i < 12; ++i) {
    const auto row = static_cast<Eigen::Index>(i % 3);
    const auto node = static_cast<Eigen::Index>(i / 3);
    EXPECT_NEAR(points[i], result.x_W(row, node), 1e-11);
    EXPECT_NEAR(displacement[i], node == 1 ? moved(row) : 0.0, 1e-12);
  }
}

TEST(VtuWriter, RefusesAResultOfAnotherMesh) {
  StepResult result;
  result.x_W.resize(3, 7);
  std::ostringstream text;
  CupArray cups;
  cups.mesh = OneTet();
  EXPECT_THROW(WriteVtu(cups, result, &text), std::invalid_argument);
}

}  // namespace
}  // namespace vacuum_gripper_sim
