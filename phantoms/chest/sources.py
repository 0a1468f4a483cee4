"""Where the chest's figures come from; everything that is not named here is an estimate."""

from __future__ import annotations

from typing import Final

SOURCES: Final = (
    "Brakohiapa et al., Pan African Medical Journal 2017, 27:201: on 1047 PA radiographs the"
    " transverse heart is 130.8 ± 12 mm in men and 129 ± 13 mm in women, the chest 297 ± 27 and"
    " 271 ± 26 mm, their ratio 0.466 ± 0.039 and 0.478 ± 0.048.",
    "Assessment of diaphragmatic levels on plain chest radiograph, West African Journal of Medicine"
    " 2007: from the apex of the lung to its hemidiaphragm right 229 and 215 mm, left 244 and"
    " 226 mm (526 PA radiographs, men and women).",
    "Holcombe, Kang, Derstine, Wang, Agnew, Journal of Anatomy 2019, 235:883: the pleural cortex of"
    " the sixth rib, at its thickest, 1.4 mm on average (0.9 to 2.6 mm).",
    "Holcombe, Derstine, Journal of Anatomy 2022, 241:1344: whole ribs' cortex thins by 0.011 to"
    " 0.032 mm a decade in men and 0.035 to 0.043 mm in women.",
    "Fletcher, Stringer, Briggs, Davies, Woodley, CT morphometry of adult thoracic intervertebral"
    " discs: anterior height 2.7 mm at T4-5 to 5.4 mm at T10-11 in men, 2.6 to 5.1 mm in women.",
    "A morphometric study of the vertebral body in dry human typical thoracic vertebrae (200"
    " bones): 27.0 ± 2.1 mm across, 20.8 ± 3.4 mm deep, 17.2 ± 1.7 mm high in front.",
    "Ritzel, Amling, Pösl, Hahn, Delling, Journal of Bone and Mineral Research 1997, 12:89: the"
    " shell of a vertebral body is 0.244 mm thick in the thoracic spine, 0.290 mm in the lumbar.",
    "Silva, Wang, Keaveny, Hayes 1994: shell and end plates of L1 are 0.35 mm thick on average,"
    " porous, and seem twice as thick on CT.",
    "Hager et al., Journal of Thoracic and Cardiovascular Surgery 2002, 123:1060: the aorta is 30.9"
    " ± 4.1 mm wide ascending, 27.7 ± 3.7 in the arch, 24.7 ± 4.0 at the isthmus, 24.3 ± 3.5 at the"
    " diaphragm, and widens with age.",
    "Thoracic kyphosis on 885 lateral radiographs (T3 to T10), Korean study: 17° to 34° over all"
    " ages, rising with age and alike in both sexes.",
    "Bellemare, Fuamba, Bourgeault, Respiratory Physiology and Neurobiology 2006, 150:233: the"
    " thoracic spine is the same share of stature in men and women.",
)
