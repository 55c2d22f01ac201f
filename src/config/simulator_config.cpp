#include "vacuum_gripper_sim/config/simulator_config.h"

#include "vacuum_gripper_sim/config/cup_list.h"

namespace vacuum_gripper_sim {
namespace {

LinearSolverParameters ReadLinearSolver(ParameterReader reader) {
  LinearSolverParameters p;
  const std::string method =
      reader.GetChoice("method", {"direct", "conjugate_gradient", "asynchronous"}, "direct");
  if (method == "conjugate_gradient") p.method = LinearSolverMethod::kConjugateGradient;
  if (method == "asynchronous") p.method = LinearSolverMethod::kAsynchronous;
  const std::string precision = reader.GetChoice("precision", {"double", "single"}, "single");
  p.precision = precision == "double" ? Precision::kDouble : Precision::kSingle;
  p.tolerance = reader.GetDouble("tolerance", p.tolerance);
  p.position_tolerance = reader.GetDouble("position_tolerance", p.position_tolerance);
  p.max_iterations = reader.GetInt("max_iterations", p.max_iterations);
  p.refactor_interval = reader.GetInt("refactor_interval", p.refactor_interval);
  p.threads = reader.GetInt("threads", p.threads);
  reader.CheckNoUnknownKeys();
  return p;
}

ContactParameters ReadContact(ParameterReader reader) {
  ContactParameters p;
  const std::string solver =
      reader.GetChoice("solver", {"active_set", "gauss_seidel"}, "active_set");
  p.method =
      solver == "active_set" ? ContactSolverMethod::kActiveSet : ContactSolverMethod::kGaussSeidel;
  p.tolerance = reader.GetDouble("tolerance", p.tolerance);
  p.acceptable_residual = reader.GetDouble("acceptable_residual", p.acceptable_residual);
  p.max_iterations = reader.GetInt("max_iterations", p.max_iterations);
  p.relaxation = reader.GetDouble("relaxation", p.relaxation);
  p.alarm_distance = reader.GetDouble("alarm_distance", p.alarm_distance);
  reader.CheckNoUnknownKeys();
  return p;
}

SealParameters ReadSeal(ParameterReader reader) {
  SealParameters p;
  if (reader.Has("close_gap")) p.close_gap = reader.GetDouble("close_gap");
  if (reader.Has("open_gap")) p.open_gap = reader.GetDouble("open_gap");
  p.max_rounds = reader.GetInt("max_rounds", p.max_rounds);
  p.ramp_increments = reader.GetInt("ramp_increments", p.ramp_increments);
  reader.CheckNoUnknownKeys();
  return p;
}

RegulatorParameters ReadRegulator(ParameterReader reader) {
  RegulatorParameters p;
  p.default_pressure = reader.GetDouble("default_pressure", p.default_pressure);
  p.min_pressure = reader.GetDouble("min_pressure", p.min_pressure);
  p.ramp_rate = reader.GetDouble("ramp_rate", p.ramp_rate);
  reader.CheckNoUnknownKeys();
  return p;
}

}  // namespace

SimulatorParameters ReadSimulatorParameters(ParameterReader* reader) {
  SimulatorParameters p;
  p.gravity = reader->GetVector3("gravity", p.gravity);
  p.linear_solver = ReadLinearSolver(reader->GetMap("linear_solver"));
  p.contact = ReadContact(reader->GetMap("contact"));
  p.seal = ReadSeal(reader->GetMap("seal"));
  p.regulator = ReadRegulator(reader->GetMap("regulator"));
  const YAML::Node cups = reader->GetNode("cups");
  if (reader->Has("cups")) p.cups = ReadCupMounts(cups, reader->Name("cups"));
  return p;
}

}  // namespace vacuum_gripper_sim
