// SPDX-License-Identifier: GPL-3.0-or-later
// directional_map MESH.off TILES UV: what the library Directional makes of a closed triangle mesh, with its own
// defaults: the smoothest field of four directions, integrated with whole tiles. TILES are as many as fit in the
// diagonal of the bounding box. UV gets u and v of every corner, in the order of the triangles.
#include <directional/CartesianField.h>
#include <directional/PCFaceTangentBundle.h>
#include <directional/TriMesh.h>
#include <directional/integrate.h>
#include <directional/power_field.h>
#include <directional/power_to_raw.h>
#include <directional/principal_matching.h>
#include <directional/readOFF.h>
#include <directional/setup_integration.h>
#include <cstdlib>
#include <fstream>
#include <iomanip>

int main(int count, char** arguments) {
  if (count != 4) return 2;
  directional::TriMesh mesh, cut;
  directional::readOFF(arguments[1], mesh);
  directional::PCFaceTangentBundle bundle;
  bundle.init(mesh);
  constexpr int Directions = 4;
  directional::CartesianField power, field, combed;
  directional::power_field(bundle, Eigen::VectorXi(0), Eigen::MatrixXd(0, 3), Eigen::VectorXd(0), Directions, power,
                           true);
  directional::power_to_raw(power, Directions, field, true);
  directional::principal_matching(field);
  directional::IntegrationData options(Directions);
  options.lengthRatio = 1 / std::atof(arguments[2]);
  options.integralSeamless = true;
  directional::setup_integration(field, options, cut, combed);
  Eigen::MatrixXd values, atCorners;
  if (!directional::integrate(combed, options, cut, values, atCorners)) return 1;
  std::ofstream uv(arguments[3]);
  uv << std::setprecision(17);
  for (int triangle = 0; triangle < cut.F.rows(); ++triangle)
    for (int corner = 0; corner < 3; ++corner) {
      const int vertex = cut.F(triangle, corner);
      uv << values(vertex, 0) << ' ' << values(vertex, 1) << '\n';
    }
  return uv ? 0 : 1;
}
