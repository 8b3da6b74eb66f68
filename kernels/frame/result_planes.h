/* The one table of result planes, in memory order; the status bytes follow them. X(name, unit,
 * value): name and unit in files, member of Solution. Force planes always exist, the others if the
 * plan requests them. */
#define PF_FORCE_PLANES(X)     \
  X(shear_x, n, force.shear_x) \
  X(shear_y, n, force.shear_y) \
  X(normal, n, force.normal)

#define PF_ANGLE_PLANES(X)             \
  X(magnitude, n, direction.magnitude) \
  X(theta, rad, direction.theta)       \
  X(phi, rad, direction.phi)

#define PF_UNCERTAINTY_PLANES(X)              \
  X(shear_x, n, deviations.shear_x)           \
  X(shear_y, n, deviations.shear_y)           \
  X(normal, n, deviations.normal)             \
  X(theta_low, rad, interval.theta_low)       \
  X(theta_high, rad, interval.theta_high)     \
  X(phi_low, rad, interval.phi_low)           \
  X(phi_high, rad, interval.phi_high)         \
  X(magnitude_low, n, interval.magnitude_low) \
  X(magnitude_high, n, interval.magnitude_high)
