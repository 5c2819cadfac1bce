// From light to what a screen can show.

// Bright light bends softly towards white instead of clipping; below the knee nothing changes. For clay, whose light
// is made to fit.
fn rolled_off(light: vec3f) -> vec3f {
    const KNEE: f32 = 0.50;
    let over = max(light - KNEE, vec3f(0.0)) / (1.0 - KNEE);
    return min(light, vec3f(KNEE)) + (1.0 - KNEE) * over / (1.0 + over);
}

// Film's shoulder for light of any strength, with the constants of the Khronos PBR Neutral Tone Mapper (2024): a base
// colour under even light is shown as the file says, and only what is brighter is compressed, fading towards white as
// it does on film. Curves that bend the middle as well (ACES above all) turn the colours that a scan was graded to.
fn filmed(light: vec3f) -> vec3f {
    const SHOULDER: f32 = 0.76;
    const FADING: f32 = 0.15;
    let least = min(light.r, min(light.g, light.b));
    // What a dielectric mirrors of white light is taken off, so that base colours come out as they are.
    let toe = select(0.04, least - 6.25 * least * least, least < 0.08);
    let shown = light - toe;
    let peak = max(shown.r, max(shown.g, shown.b));
    if peak < SHOULDER {
        return shown;
    }
    let room = 1.0 - SHOULDER;
    let lowered = 1.0 - room * room / (peak + room - SHOULDER);
    let faded = 1.0 - 1.0 / (FADING * (peak - lowered) + 1.0);
    return mix(shown * (lowered / peak), vec3f(lowered), faded);
}
