#pragma once

namespace vacuum_gripper_sim {

/** Air as an ideal gas at a constant temperature T. An amount of it is N = p V = m R T [Pa m^3], a
 flow the throughput Q = dN/dt [Pa m^3/s]; Q / p_ambient is its volume a second as free air.
 Pressures here are absolute. */
namespace air {
inline constexpr double kGasConstant = 287.06;        ///< R [J/(kg K)]
inline constexpr double kTemperature = 293.15;        ///< T [K]
inline constexpr double kHeatRatio = 1.4;             ///< gamma
inline constexpr double kViscosity = 1.81e-5;         ///< mu at T [Pa s]
inline constexpr double kAmbientPressure = 101325.0;  ///< Where nothing else is said. [Pa]
}  // namespace air

/** Isentropic flow through an orifice, choked below the critical ratio of pressures:

     Q = A p_u sqrt(R T) psi(p_d / p_u),
     psi(r) = sqrt(2 g/(g-1) (r^(2/g) - r^((g+1)/g))),  r not below (2/(g+1))^(g/(g-1)) = .528,

 from the larger pressure p_u to the smaller one p_d [Saint-Venant and Wantzel 1839]. Within a
 thousandth of equal pressures Q is linear in their difference, so that its slope stays finite, as
 ISO 6358-1:2013 suggests for computation.

 @param area Effective, its coefficient of discharge included. [m^2] >= 0
 @param p_from,p_to Absolute. [Pa] >= 0
 @returns throughput, negative if it goes from `p_to` to `p_from`. [Pa m^3/s] */
double OrificeThroughput(double area, double p_from, double p_to);

/** Laminar isothermal flow of air through a slit whose gap g varies along its length [Poiseuille;
 for gases e.g. Roth 1976, Vacuum Technology],

     Q = (p_from^2 - p_to^2) / (24 mu) * integral of dw / (integral of ds / g^3).

 @param shape The double integral. [m^3]
 @param p_from,p_to Absolute. [Pa]
 @returns throughput. [Pa m^3/s] */
double SlitThroughput(double shape, double p_from, double p_to);

}  // namespace vacuum_gripper_sim
