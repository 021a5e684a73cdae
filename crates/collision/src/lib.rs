//! GJK, EPA, ray and shape casts and a triangle BVH in f64.
