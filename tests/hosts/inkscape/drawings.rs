//! Small drawings with all objects from which Inkscape computes a shape. The page is 200 px wide and high.

/// Name and content.
pub const DRAWINGS: &[(&str, &str)] = &[
    (
        "arc",
        "<path id='a' sodipodi:type='arc' style='fill:#c03030' sodipodi:cx='100' sodipodi:cy='100' sodipodi:rx='80' \
         sodipodi:ry='60' sodipodi:start='0.5' sodipodi:end='5.2' sodipodi:arc-type='slice' \
         d='M 170.21,128.77 A 80,60 0 0 1 76.6,157.4 80,60 0 0 1 137.5,47 L 100,100 Z'/>",
    ),
    (
        "star",
        "<path id='a' sodipodi:type='star' style='fill:#c03030' inkscape:flatsided='false' sodipodi:sides='5' \
         sodipodi:cx='100' sodipodi:cy='100' sodipodi:r1='80' sodipodi:r2='32' sodipodi:arg1='-1.57' sodipodi:arg2='-0.94' \
         inkscape:rounded='0' inkscape:randomized='0' inkscape:transform-center-x='9' inkscape:transform-center-y='4' \
         d='M 100,20 118.8,74.1 176,75.3 130.4,109.9 147,164.7 100,132 53,164.7 69.6,109.9 24,75.3 81.2,74.1 Z'/>",
    ),
    (
        "spiral",
        "<path id='a' sodipodi:type='spiral' style='fill:#c03030' sodipodi:cx='100' sodipodi:cy='100' sodipodi:expansion='1' \
         sodipodi:revolution='3' sodipodi:radius='80' sodipodi:argument='0' sodipodi:t0='0' \
         d='M 100,100 C 120,130 60,150 50,100 40,40 150,20 170,90 175,110 178,105 180,100'/>",
    ),
    (
        "spiral with a stroke",
        "<path id='a' sodipodi:type='spiral' style='fill:none;stroke:#c03030;stroke-width:9' sodipodi:cx='100' \
         sodipodi:cy='100' sodipodi:expansion='1' sodipodi:revolution='3' sodipodi:radius='80' sodipodi:argument='0' \
         sodipodi:t0='0' d='M 100,100 C 120,130 60,150 50,100 40,40 150,20 170,90 175,110 178,105 180,100'/>",
    ),
    (
        "dynamic offset",
        "<path id='a' sodipodi:type='inkscape:offset' inkscape:radius='10' inkscape:original='M 40,40 H 160 V 160 H 40 Z' \
         style='fill:#c03030' d='M 40,30 A 10,10 0 0 0 30,40 V 160 A 10,10 0 0 0 40,170 H 160 A 10,10 0 0 0 170,160 V 40 A \
         10,10 0 0 0 160,30 Z'/>",
    ),
    (
        "linked offset",
        "<path id='o' style='fill:#fc0' d='M 60,60 H 140 V 140 H 60 Z'/><path id='a' sodipodi:type='inkscape:offset' \
         inkscape:radius='20' xlink:href='#o' inkscape:href='#o' style='fill:none;stroke:#000;stroke-width:4' \
         d='M 60,40 A 20,20 0 0 0 40,60 V 140 A 20,20 0 0 0 60,160 H 140 A 20,20 0 0 0 160,140 V 60 A 20,20 0 0 0 140,40 Z'/>",
    ),
    (
        "3D box",
        "<defs><inkscape:perspective sodipodi:type='inkscape:persp3d' inkscape:vp_x='0 : 100 : 1' inkscape:vp_y='0 : 1000 : \
         0' inkscape:vp_z='200 : 100 : 1' inkscape:persp3d-origin='100 : 66 : 1' id='p'/></defs><g id='b' \
         sodipodi:type='inkscape:box3d' style='fill:none' inkscape:perspectiveID='#p' inkscape:corner0='0.5 : 0.1 : 0 : 1' \
         inkscape:corner7='0.2 : 0.4 : 0.25 : 1'><path id='a' sodipodi:type='inkscape:box3dside' style='fill:#353564' \
         inkscape:box3dsidetype='6' d='M 40,60 V 140 L 100,170 V 80 Z'/><path id='c' sodipodi:type='inkscape:box3dside' \
         style='fill:#8686bf' inkscape:box3dsidetype='13' d='M 100,80 V 170 L 160,140 V 60 Z'/></g>",
    ),
    (
        "path effect",
        "<defs><inkscape:path-effect effect='roughen' id='e' is_visible='true' lpeversion='1.2' method='size' \
         max_segment_size='10' segments='2' displace_x='8;1' displace_y='8;1' global_randomize='1;1' handles='along' \
         shift_nodes='true' fixed_displacement='false' spray_tool_friendly='false' seed='1;1'/></defs><path id='a' \
         style='fill:#c03030' inkscape:path-effect='#e' inkscape:original-d='M 20,20 H 180 V 180 H 20 Z' \
         d='M 20,20 H 180 V 180 H 20 Z'/>",
    ),
    (
        "path effect of a rectangle",
        "<defs><inkscape:path-effect effect='fillet_chamfer' id='e' is_visible='true' lpeversion='1' unit='px' method='auto' \
         mode='F' radius='30' chamfer_steps='1' flexible='false' use_knot_distance='true' apply_no_radius='true' \
         apply_with_radius='true' only_selected='false' hide_knots='false' nodesatellites_param='F,0,0,1,0,30,0,1 @ \
         F,0,0,1,0,30,0,1 @ F,0,0,1,0,30,0,1 @ F,0,0,1,0,30,0,1'/></defs><path id='a' sodipodi:type='rect' x='20' y='20' \
         width='160' height='120' style='fill:#c03030' inkscape:path-effect='#e' \
         d='M 50,20 H 150 A 30,30 0 0 1 180,50 V 110 A 30,30 0 0 1 150,140 H 50 A 30,30 0 0 1 20,110 V 50 A 30,30 0 0 1 50,20 Z'/>",
    ),
    (
        "path effect of a group",
        "<defs><inkscape:path-effect effect='roughen' id='e' is_visible='true' lpeversion='1.2' method='size' \
         max_segment_size='10' segments='2' displace_x='8;1' displace_y='8;1' global_randomize='1;1' handles='along' \
         shift_nodes='true' fixed_displacement='false' spray_tool_friendly='false' seed='1;1'/></defs><g id='g' \
         inkscape:path-effect='#e'><g id='h'><path id='a' style='fill:#c03030' inkscape:original-d='M 20,20 H 180 V 90 H 20 Z' \
         d='M 20,20 H 180 V 90 H 20 Z'/></g><path id='c' style='fill:#30c030' \
         inkscape:original-d='M 20,110 H 180 V 180 H 20 Z' d='M 20,110 H 180 V 180 H 20 Z'/></g>",
    ),
    (
        "power stroke",
        "<defs><inkscape:path-effect effect='powerstroke' id='e' is_visible='true' lpeversion='1.3' scale_width='1' \
         interpolator_type='CubicBezierJohan' interpolator_beta='0.2' start_linecap_type='zerowidth' \
         end_linecap_type='zerowidth' offset_points='0.2,10 | 0.8,5' linejoin_type='extrp_arc' miter_limit='4' \
         not_jump='false' sort_points='true'/></defs><path id='a' inkscape:path-effect='#e' \
         inkscape:original-d='M 20,100 C 60,20 140,180 180,100' \
         d='M 20,95 C 60,15 140,170 180,90 L 180,110 C 140,190 60,25 20,105 Z'/>",
    ),
    (
        "clip path and mask",
        "<defs><clipPath id='c' clipPathUnits='userSpaceOnUse'><path id='a' sodipodi:type='star' inkscape:flatsided='true' \
         sodipodi:sides='3' sodipodi:cx='100' sodipodi:cy='100' sodipodi:r1='95' sodipodi:r2='47' sodipodi:arg1='-1.57' \
         sodipodi:arg2='-0.52' inkscape:rounded='0' inkscape:randomized='0' d='M 100,5 182,147 18,147 Z'/></clipPath><mask \
         id='m' maskUnits='userSpaceOnUse'><path id='d' sodipodi:type='arc' style='fill:#fff' sodipodi:cx='100' \
         sodipodi:cy='120' sodipodi:rx='60' sodipodi:ry='60' sodipodi:start='0' sodipodi:end='3.14' sodipodi:open='true' \
         d='M 160,120 A 60,60 0 0 1 40,120'/></mask></defs><g id='g' clip-path='url(#c)'><rect id='r' width='200' \
         height='200' style='fill:#fc0'/></g><g id='h' mask='url(#m)'><rect id='s' width='200' height='200' \
         style='fill:#06c'/></g>",
    ),
    (
        "clones",
        "<path id='a' style='fill:#c03030' d='M 20,20 H 60 V 60 H 20 Z'/><use id='u' xlink:href='#a' \
         transform='translate(70,0)' inkscape:tiled-clone-of='#a' inkscape:tile-cx='40' inkscape:tile-cy='40'/><use id='v' \
         xlink:href='#a' transform='translate(0,60) rotate(10)' inkscape:transform-center-x='2'/>",
    ),
    (
        "connector",
        "<rect id='k' style='fill:#c03030' x='20' y='20' width='40' height='40' inkscape:connector-avoid='true'/><rect \
         id='l' style='fill:#c03030' x='130' y='130' width='40' height='40'/><path id='a' \
         style='fill:none;stroke:#000;stroke-width:4' d='M 60,50 L 130,140' inkscape:connector-type='polyline' \
         inkscape:connector-curvature='0' inkscape:connection-start='#k' inkscape:connection-end='#l'/>",
    ),
    (
        "texts",
        "<path id='a' style='fill:none;stroke:#888;stroke-width:3' sodipodi:nodetypes='cc' \
         d='M 20,150 C 60,20 140,20 180,150'/><text id='t' xml:space='preserve' sodipodi:linespacing='125%' \
         style='font-size:40px;line-height:1.25' x='10' y='60'><tspan sodipodi:role='line' id='s' x='10' \
         y='60'>Hello</tspan><tspan sodipodi:role='line' id='w' x='10' y='110'>World</tspan></text><text id='p' \
         style='font-size:24px'><textPath xlink:href='#a' id='q'>Along a path</textPath></text>",
    ),
];
