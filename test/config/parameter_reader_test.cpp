#include "vacuum_gripper_sim/config/parameter_reader.h"

#include <gtest/gtest.h>

#include <cmath>

#include "config_test_tools.h"

namespace vacuum_gripper_sim {
namespace {

ParameterReader Reader(const std::string& yaml) { return ParameterReader(YAML::Load(yaml), "top"); }

TEST(ParameterReader, ReadsEveryType) {
  ParameterReader reader =
      Reader("{d: -6.0e+3, i: 7, b: true, s: text, v: [1, 2.5, -3], c: two, q: [0, 0, 0, 1]}");
  EXPECT_EQ(reader.GetDouble("d"), -6000.0);
  EXPECT_EQ(reader.GetDouble("i"), 7.0);  // a whole number is a number
  EXPECT_EQ(reader.GetInt("i"), 7);
  EXPECT_TRUE(reader.GetBool("b", false));
  EXPECT_EQ(reader.GetString("s"), "text");
  EXPECT_EQ(reader.GetVector3("v"), Eigen::Vector3d(1.0, 2.5, -3.0));
  EXPECT_EQ(reader.GetChoice("c", {"one", "two"}, "one"), "two");
  EXPECT_TRUE(reader.GetRotation("q", Eigen::Quaterniond(0, 1, 0, 0))
                  .isApprox(Eigen::Quaterniond::Identity()));
  EXPECT_NO_THROW(reader.CheckNoUnknownKeys());
}

TEST(ParameterReader, KeepsDefaultsOfAbsentKeys) {
  ParameterReader reader = Reader("{}");
  EXPECT_EQ(reader.GetDouble("d", 1.5), 1.5);
  EXPECT_EQ(reader.GetInt("i", 3), 3);
  EXPECT_TRUE(reader.GetBool("b", true));
  EXPECT_EQ(reader.GetString("s", "x"), "x");
  EXPECT_EQ(reader.GetChoice("c", {"one", "two"}, "one"), "one");
  EXPECT_EQ(reader.GetVector3("v", Eigen::Vector3d::Ones()), Eigen::Vector3d::Ones());
  EXPECT_EQ(reader.GetMap("m").GetDouble("d", 2.0), 2.0);
}

TEST(ParameterReader, TellsNotSetFromNoValueFromWrongType) {
  EXPECT_EQ(ErrorOf([] { Reader("{}").GetDouble("x"); }), "top.x is not set; expected a number");
  EXPECT_EQ(ErrorOf([] { Reader("{x: }").GetDouble("x"); }),
            "top.x has no value; expected a number");
  EXPECT_EQ(ErrorOf([] { Reader("{x: soft}").GetDouble("x"); }), "top.x = soft; expected a number");
  EXPECT_EQ(ErrorOf([] { Reader("{x: [1, 2]}").GetDouble("x"); }),
            "top.x = [1, 2]; expected a number");
}

TEST(ParameterReader, ExplainsTheExponentTrap) {
  // What rosparam makes of 593.0e3: text. The tag is how the node hands text on.
  YAML::Node node;
  node["x"] = "593.0e3";
  node["x"].SetTag("!");
  const std::string error = ErrorOf([&] { ParameterReader(node).GetDouble("x"); });
  EXPECT_TRUE(Contains(error, "x = 593.0e3 (text)")) << error;
  EXPECT_TRUE(Contains(error, "593.0e+3")) << error;
  // A file of ours that is read by this reader alone has no such trap.
  EXPECT_EQ(Reader("{x: 593.0e3}").GetDouble("x"), 593000.0);
  EXPECT_EQ(Reader("{x: 1e-9}").GetDouble("x"), 1e-9);
}

TEST(ParameterReader, RefusesWhatIsNotFinite) {
  for (const char* value : {".nan", ".inf", "-.inf", "1.0e+999", "-1.0e+999"}) {
    EXPECT_TRUE(Contains(ErrorOf([&] { Reader(std::string("x: ") + value).GetDouble("x"); }),
                         "a finite number"))
        << value;
  }
}

TEST(ParameterReader, RefusesNumbersWithRests) {
  for (const char* value : {"1.0mm", "0x10", "1,5", "1 2", "--1", "e5", "1.0e", "nan", "''"}) {
    EXPECT_THROW(Reader(std::string("x: ") + value).GetDouble("x"), std::invalid_argument) << value;
  }
}

TEST(ParameterReader, RefusesBadIntegers) {
  for (const char* value : {"1.5", "2.0", "1e3", "'3'", "true", "99999999999"}) {
    EXPECT_THROW(Reader(std::string("x: ") + value).GetInt("x"), std::invalid_argument) << value;
  }
  EXPECT_EQ(Reader("x: 010").GetInt("x"), 10);  // decimal, not octal
}

TEST(ParameterReader, RefusesBadBooleansChoicesAndText) {
  EXPECT_EQ(ErrorOf([] { Reader("x: 2").GetBool("x", true); }),
            "top.x = 2; expected true or false");
  EXPECT_EQ(ErrorOf([] {
              Reader("x: three").GetChoice("x", {"one", "two"}, "one");
            }),
            "top.x = three; expected one or two");
  EXPECT_EQ(ErrorOf([] { Reader("x: {a: 1}").GetString("x"); }), "top.x = {a: 1}; expected text");
}

TEST(ParameterReader, RefusesBadVectors) {
  EXPECT_EQ(ErrorOf([] { Reader("x: [1, 2]").GetVector3("x"); }),
            "top.x = [1, 2]; expected a list of 3 numbers");
  EXPECT_EQ(ErrorOf([] { Reader("x: [1, 2, up]").GetVector3("x"); }),
            "top.x.2 = up; expected a number");
}

TEST(ParameterReader, ReadsRotationsAboutFixedAxes) {
  // Roll of 90 degrees takes y to z, the yaw of 90 degrees after it leaves z alone and takes x to
  // y.
  const Eigen::Quaterniond q = Reader("x: [1.5707963267948966, 0, 1.5707963267948966]")
                                   .GetRotation("x", Eigen::Quaterniond::Identity());
  EXPECT_TRUE((q * Eigen::Vector3d::UnitY()).isApprox(Eigen::Vector3d::UnitZ(), 1e-12));
  EXPECT_TRUE((q * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitY(), 1e-12));
}

TEST(ParameterReader, NormalisesQuaternionsThatAreNearlyUnit) {
  const Eigen::Quaterniond q =
      Reader("x: [0.0, 0.7071, 0.0, 0.7071]").GetRotation("x", Eigen::Quaterniond::Identity());
  EXPECT_NEAR(q.norm(), 1.0, 1e-15);
  EXPECT_NEAR(q.y(), std::sqrt(0.5), 1e-12);
  const Eigen::Quaterniond unused = Eigen::Quaterniond::Identity();
  EXPECT_THROW(Reader("x: [0, 0, 0, 1.01]").GetRotation("x", unused), std::invalid_argument);
  EXPECT_THROW(Reader("x: [0, 1]").GetRotation("x", unused), std::invalid_argument);
}

TEST(ParameterReader, RefusesUnknownKeysAndNamesTheKnown) {
  ParameterReader reader = Reader("{tolerance: 1.0, tolerence: 2.0}");
  reader.GetDouble("tolerance");
  reader.GetDouble("relaxation", 1.0);
  EXPECT_EQ(ErrorOf([&] { reader.CheckNoUnknownKeys(); }),
            "top.tolerence is not a known key; expected one of: relaxation, tolerance");
}

TEST(ParameterReader, RefusesKeysThatAreSetTwice) {
  EXPECT_EQ(ErrorOf([] { Reader("{a: 1, b: 2, a: 3}"); }), "top.a is set twice; expected once");
}

TEST(ParameterReader, RefusesWhatIsNoMap) {
  EXPECT_EQ(ErrorOf([] { Reader("{m: 5}").GetMap("m"); }), "top.m = 5; expected a map of keys");
  EXPECT_EQ(ErrorOf([] { ParameterReader(YAML::Load("[1]"), ""); }),
            "the document = [1]; expected a map of keys");
}

}  // namespace
}  // namespace vacuum_gripper_sim
