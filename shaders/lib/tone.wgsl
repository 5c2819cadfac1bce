// Tone mapping.

// Highlight roll-off: bright light bends towards white instead of clipping; below the knee nothing changes. It serves
// matcaps, whose light is made to fit.
fn rolled_off(light: vec3f) -> vec3f {
    const KNEE: f32 = 0.50;
    let over = max(light - KNEE, vec3f(0.0)) / (1.0 - KNEE);
    return min(light, vec3f(KNEE)) + (1.0 - KNEE) * over / (1.0 + over);
}

// The Khronos PBR Neutral Tone Mapper [Khr24]. Base colours under even light are shown as the file defines them; only
// brighter light is compressed and desaturated. Curves that also bend the mid-tones, such as ACES, would shift the
// colours of a graded scan.
fn neutral_tone_mapped(light: vec3f) -> vec3f {
    const SHOULDER: f32 = 0.76;
    const DESATURATION: f32 = 0.15;
    let least = min(light.r, min(light.g, light.b));
    // Subtract the reflection of a dielectric under white light, so that base colours are shown exactly.
    let toe = select(0.04, least - 6.25 * least * least, least < 0.08);
    let shown = light - toe;
    let peak = max(shown.r, max(shown.g, shown.b));
    if peak < SHOULDER {
        return shown;
    }
    let range = 1.0 - SHOULDER;
    let compressed = 1.0 - range * range / (peak + range - SHOULDER);
    let desaturated = 1.0 - 1.0 / (DESATURATION * (peak - compressed) + 1.0);
    return mix(shown * (compressed / peak), vec3f(compressed), desaturated);
}
