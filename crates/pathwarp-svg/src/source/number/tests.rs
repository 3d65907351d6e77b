use super::*;
use pathwarp::kurbo::Affine;

#[test]
fn shortest_form_without_minus_zero() {
    let n = |v, d| {
        let mut s = String::new();
        push(&mut s, v, d);
        s
    };
    assert_eq!(n(1.50, 3), "1.5");
    assert_eq!(n(-0.0001, 2), "0");
    assert_eq!(n(100.0, 2), "100");
    assert_eq!(n(1e6 + 0.001, 3), "1000000.001");
    assert_eq!(n(-0.05, 3), "-0.05");
    assert_eq!(n(0.007, 3), "0.007");
    assert_eq!(n(120.0, 0), "120");
    assert_eq!(n(1e20, 3), "100000000000000000000");
    assert_eq!(n(-12345.678, 2), "-12345.68");
    assert_eq!(short(0.000_012_345), "0.000012345");
    assert_eq!(short(1234.5), "1234.5");
    assert_eq!(short(-1e-40), "0");
}

/// Compares with the standard library, which rounds the exact value of the number.
#[test]
fn every_number_of_decimals_agrees_with_the_standard_library() {
    let mut seed = 7_u64;
    for i in 0..100_000_u32 {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let decimals = (seed >> 59) as u8 % (MAX_DECIMALS + 1);
        let v = ((seed >> 11) as f64 / 2f64.powi(52) - 1.0) * 10f64.powi((i % 16) as i32 - 4);
        let mut out = String::new();
        push(&mut out, v, decimals);
        let mut wanted = String::new();
        push_trimmed(&mut wanted, v, usize::from(decimals));
        // The product with a power of ten is rounded once more, which decides only near a tie.
        let product = v * POWERS[usize::from(decimals)];
        let tie = ((product.fract().abs() - 0.5).abs() * 1e15) < product.abs().max(1.0) * 4.0;
        assert!(out == wanted || tie, "{v:e} to {decimals}: {out} {wanted}");
    }
}

#[test]
fn outlines_are_written_to_the_last_bit() {
    let d = "M0.1 0.30000000000000004Q1 2 3 4C5 6 7 8 9 10A50 30 0 1 0 -4 0.0000001L8 8ZM1 1A2 2 0 0 1 3 1";
    let o = Outline::from_svg(d).unwrap();
    assert_eq!(outline_data(&o), d);
    // Numbers that come from an f32 are written as such.
    let mut p = BezPath::new();
    p.move_to((f64::from(0.1_f32), 2.0));
    assert_eq!(outline_data(&(&p).into()), "M0.1 2");
}

/// Compares with the standard library's formatting.
#[test]
fn exact_numbers_are_the_shortest_there_are() {
    let mut seed = 1_u64;
    for i in 0..200_000_u32 {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let few = (seed >> 44) as f64 - 524_288.0;
        let v = match i % 4 {
            0 => few / 1000.0,
            1 => f64::from((few / 1000.0) as f32),
            2 => f64::from((few * 1e-3) as f32) + f64::EPSILON * few,
            _ => f64::from_bits(f64::to_bits(few / 100.0) ^ (seed >> 20 & 1)),
        };
        let mut out = String::new();
        push_exact(&mut out, v);
        let single = v as f32;
        let wanted = if f64::from(single) == v { single.to_string() } else { v.to_string() };
        assert_eq!(out, wanted);
        // Compare rounding to three decimals, too.
        out.clear();
        push(&mut out, v, 3);
        let wanted = format!("{v:.3}");
        let wanted = wanted.trim_end_matches('0').trim_end_matches('.');
        let halfway = (v * 1000.0).fract().abs() == 0.5;
        assert!(out == wanted || halfway || wanted == "-0" && out == "0", "{out} {wanted}");
    }
}

#[test]
fn arcs_stay_where_they_are_whatever_their_axes() {
    let o = Outline::from_svg("M0 0A50 30 25 0 1 40 10A9 9 0 1 1 41 10").unwrap();
    for m in [Affine::IDENTITY, Affine::rotate(2.0), Affine::new([1.0, 0.2, 0.5, 0.8, 3.0, 4.0]), Affine::FLIP_Y] {
        let o = o.transformed(m);
        let again = Outline::from_svg(&outline_data(&o)).unwrap();
        let far = |a: &Outline, b: &Outline| {
            let near = |p: Point| {
                let d = b.segs().flat_map(|s| (0..=2000).map(move |i| s.eval(f64::from(i) / 2000.0).distance(p)));
                d.fold(f64::INFINITY, f64::min)
            };
            a.segs().flat_map(|s| [0.0, 0.3, 0.5, 0.8, 1.0].map(|t| near(s.eval(t)))).fold(0.0, f64::max)
        };
        // Half the distance between neighbouring samples on the longer arc.
        assert!(far(&o, &again) < 0.05 && far(&again, &o) < 0.05, "{}", outline_data(&o));
    }
}

#[test]
fn raised_quadratics_come_down_again() {
    let q = pathwarp::kurbo::QuadBez::new((0.0, 0.0), (1.0, 7.0), (10.0, 0.0)).raise();
    let mut p = BezPath::new();
    p.move_to(q.p0);
    p.curve_to(q.p1, q.p2, q.p3);
    p.curve_to((11.0, 1.0), (12.0, 0.0), (13.0, 5.0));
    p.close_path();
    assert_eq!(path_data(&p, 3), "M0,0 Q1,7 10,0 C11,1 12,0 13,5 Z");
}
