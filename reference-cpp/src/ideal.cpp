#include "ideal.hpp"

Scene idealised(const Scene &scene) {
    Scene ideal = scene;
    auto center = [&](int body) { return Vec<double>{0.5 * scene.bodies[body].length, 0.0}; }; // of a link
    auto move = [&](PointReference &point) { point.at = point.at - center(point.body); };
    for (std::size_t i = 0; i < ideal.bodies.size(); ++i) {
        BodyDescription &body = ideal.bodies[i];
        for (NamedPoint &point : body.points) point.at = point.at - center(static_cast<int>(i));
        if (body.is_link()) body.kind = BodyKind::rigid_body;
        body.strain_damping = body.mass_damping = 0.0;
    }
    for (JointDescription &joint : ideal.joints) {
        move(joint.first);
        move(joint.second);
        joint.law.reset();
        joint.slope_vector = false;
    }
    for (PointDrive &drive : ideal.point_drives) move(drive.point);
    for (SketchedPoint &point : ideal.initial.points) move(point.point);
    if (ideal.inverse_kinematics) ideal.bodies[ideal.inverse_kinematics->body].path = ideal.inverse_kinematics->path;
    ideal.springs.clear();
    ideal.torsion_springs.clear();
    ideal.maxwells.clear();
    ideal.loads.clear();
    return ideal;
}
