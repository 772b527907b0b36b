#include "haptex/cloth/dynamics/particle_contact.h"

#include <algorithm>
#include <cmath>

#include "haptex/base/require.h"

namespace haptex::cloth {

void requireSound(const std::vector<ParticleContact>& contacts, std::vector<char>& particles,
                  std::size_t bodies) {
  constexpr double kUnit = 1e-6;
  std::fill(particles.begin(), particles.end(), 0);
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const ParticleContact& contact = contacts[i];
    if (contact.particle < 0 || contact.particle >= static_cast<int>(particles.size())) {
      base::refuse("contact ", i, ": particle ", contact.particle,
                   " does not exist; the cloth has particles 0 to ", particles.size() - 1);
    }
    if (particles[contact.particle]) {
      base::refuse("contact ", i, ": particle ", contact.particle,
                   " has another contact; allowed is one");
    }
    particles[contact.particle] = 1;
    if (!contact.normal.allFinite() || !contact.place.allFinite() || !std::isfinite(contact.gap) ||
        !contact.velocity.allFinite() || !std::isfinite(contact.friction) ||
        !std::isfinite(contact.end) || !contact.arm.allFinite()) {
      base::refuse("contact ", i, ": a number is not finite");
    }
    if (!(std::abs(contact.normal.norm() - 1.0) <= kUnit)) {
      base::refuse("contact ", i, ": the normal has the length ", contact.normal.norm(),
                   "; allowed is 1 within ", kUnit);
    }
    if (contact.body < -1 || contact.body >= static_cast<int>(bodies)) {
      base::refuse("contact ", i, ": body ", contact.body, " does not exist; there are ", bodies,
                   ", and -1 is none");
    }
    if (contact.friction < 0.0) {
      base::refuse("contact ", i, ": friction is ", contact.friction, "; it must be at least 0");
    }
  }
}

}  // namespace haptex::cloth
