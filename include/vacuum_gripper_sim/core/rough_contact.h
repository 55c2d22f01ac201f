#pragma once

namespace vacuum_gripper_sim {

/** Contact of a soft body with a hard, randomly rough surface.

 Squeezed together with the nominal pressure p they keep a mean separation u apart,

     p = beta E* exp(-alpha u / h_rms),

 [Persson 2007, Yang and Persson 2008; for suction cups Tiwari and Persson 2019]. alpha and beta
 depend on the spectrum of the roughness and are of order one; that of a work piece is hardly ever
 known, so round values stand for all.

 [Persson 2007] B. N. J. Persson, "Relation between interfacial separation and load: a general
   theory of contact mechanics", Phys. Rev. Lett. 99, 125502.
 [Yang and Persson 2008] C. Yang, B. N. J. Persson, "Contact mechanics: contact area and interfacial
   separation from small contact to full contact", J. Phys.: Condens. Matter 20, 215214.
 [Tiwari and Persson 2019] A. Tiwari, B. N. J. Persson, "Physics of suction cups", Soft Matter 15,
   9482. */
namespace rough_contact {
inline constexpr double kAlpha = 2.0;  ///< Inverse of the decay length u_0 / h_rms, about a half.
inline constexpr double kBeta = 1.0;   ///< Rises with the steepness of the longest waves.
inline constexpr double kHighestPeak = 3.0;  ///< u / h_rms where the highest peaks just touch.
}  // namespace rough_contact

/** The gap of a smooth slit that lets through as much as a rough contact does,

     g = u phi^(1/3),   phi = 1 - .9 exp(-.56 u / h_rms),

 phi being the pressure flow factor of isotropic roughness [N. Patir, H. S. Cheng, "An average flow
 model for determining effects of three-dimensional roughness on partial hydrodynamic lubrication",
 J. Lubr. Technol. 100(1), 1978]. Persson's law is bent at both ends of its range, so that u falls
 from kHighestPeak h_rms without load and towards zero under a load far above beta E*:

     u = h_rms / alpha ln(1 + beta E* / (p + p_0)).

 @param h_rms Root mean square of the surface's heights; 0: smooth, nothing passes. [m] >= 0
 @param contact_pressure p: force over nominal area. [Pa] >= 0
 @param reduced_modulus E* = E / (1 - nu^2) of the soft body. [Pa] > 0
 @returns g, in proportion to h_rms, falling with p. [m] */
double HydraulicGap(double h_rms, double contact_pressure, double reduced_modulus);

}  // namespace vacuum_gripper_sim
